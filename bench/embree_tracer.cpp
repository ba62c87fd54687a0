#include "embree_tracer.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <bit>
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace steradian::bench {
namespace {

/// Embree asks for it: "flush to zero" and "denormals are zero", without which it can be slow.
class FlushDenormals {
public:
#if defined(__x86_64__)
    FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040); }
    ~FlushDenormals() { _mm_setcsr(saved_); }
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

private:
    unsigned saved_;
#endif
};

/// Rays in groups of `width`, each group holding its fields one after the other: RTCRayHitN for any N, and for N = 1
/// RTCRayHit itself. Without hits it is RTCRayN.
constexpr size_t kRayFields = 12, kHitFields = 8;
static_assert(sizeof(RTCRay) == kRayFields * sizeof(float));
static_assert(sizeof(RTCRayHit) == (kRayFields + kHitFields) * sizeof(float));
static_assert(sizeof(RTCRayHit16) == 16 * sizeof(RTCRayHit));

enum Field { org, tnear = 3, dir = 4, time = 7, tfar = 8, mask, id, flags, ng = 12, u = 15, v, prim, geom, inst };

class Groups {
public:
    Groups(size_t width, size_t count, bool any_hit)
        : width_(width), fields_(any_hit ? kRayFields : kRayFields + kHitFields) {
        lines_.resize(((count + width) * fields_ + 15) / 16);
    }
    float* group(size_t g) { return &lines_[0].values[0] + g * width_ * fields_; }
    float* field(size_t g, Field f) { return group(g) + f * width_; }
    float& at(size_t ray, Field f) { return field(ray / width_, f)[ray % width_]; }
    uint32_t id_at(size_t ray, Field f) { return std::bit_cast<uint32_t>(at(ray, f)); }
    size_t bytes() const { return width_ * fields_ * sizeof(float); }

    void set(size_t i, const Ray& ray) {
        for (int axis = 0; axis < 3; ++axis) {
            at(i, Field(org + axis)) = ray.o[axis];
            at(i, Field(dir + axis)) = ray.d[axis];
        }
        at(i, tnear) = ray.tmin;
        at(i, tfar) = ray.tmax;
        at(i, time) = 0;
        at(i, mask) = std::bit_cast<float>(~0u);
        at(i, id) = at(i, flags) = 0;
        if (fields_ > kRayFields) at(i, geom) = at(i, inst) = std::bit_cast<float>(RTC_INVALID_GEOMETRY_ID);
    }

private:
    struct alignas(64) Line {
        float values[16];
    };
    size_t width_, fields_;
    std::vector<Line> lines_;
};

class EmbreeTracer : public Tracer {
public:
    EmbreeTracer(RTCScene scene, const EmbreeFeed& feed, bool any_hit, size_t chunk)
        : scene_(scene),
          feed_(feed),
          any_hit_(any_hit),
          width_(feed.kind == EmbreeFeed::Kind::soa_stream ? chunk : feed.width),
          rays_(width_, chunk, any_hit) {}

    void load(std::span<const Ray> rays) override {
        count_ = rays.size();
        for (size_t i = 0; i < count_; ++i) rays_.set(i, rays[i]);
    }
    void trace() override {
        const FlushDenormals mode;
        rtcInitIntersectContext(&context_);
        context_.flags = feed_.coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        switch (feed_.kind) {
            case EmbreeFeed::Kind::single:
                return single();
            case EmbreeFeed::Kind::packet:
                return packets();
            case EmbreeFeed::Kind::stream:
                return stream();
            case EmbreeFeed::Kind::soa_stream:
                return soa_stream();
        }
    }
    void store(std::span<Hit> hits) override {
        for (size_t i = 0; i < count_; ++i) {
            const bool found = rays_.id_at(i, geom) != RTC_INVALID_GEOMETRY_ID;
            hits[i] = found ? Hit{rays_.at(i, tfar), rays_.at(i, u), rays_.at(i, v), rays_.id_at(i, prim), 0} : Hit{};
        }
    }
    void store(std::span<uint8_t> occluded) override {
        for (size_t i = 0; i < count_; ++i) occluded[i] = rays_.at(i, tfar) < 0;
    }

private:
    template <class T>
    T* group(size_t g) {
        return reinterpret_cast<T*>(rays_.group(g));
    }
    void single() {
        if (any_hit_) {
            for (size_t i = 0; i < count_; ++i) rtcOccluded1(scene_, &context_, group<RTCRay>(i));
        } else {
            for (size_t i = 0; i < count_; ++i) rtcIntersect1(scene_, &context_, group<RTCRayHit>(i));
        }
    }
    void packets() {
        alignas(64) int valid[16];
        for (size_t begin = 0, g = 0; begin < count_; begin += width_, ++g) {
            for (size_t lane = 0; lane < width_; ++lane) valid[lane] = begin + lane < count_ ? -1 : 0;
            packet(valid, g);
        }
    }
    void packet(const int* valid, size_t g) {
        if (any_hit_) {
            if (width_ == 4) return rtcOccluded4(valid, scene_, &context_, group<RTCRay4>(g));
            if (width_ == 8) return rtcOccluded8(valid, scene_, &context_, group<RTCRay8>(g));
            return rtcOccluded16(valid, scene_, &context_, group<RTCRay16>(g));
        }
        if (width_ == 4) return rtcIntersect4(valid, scene_, &context_, group<RTCRayHit4>(g));
        if (width_ == 8) return rtcIntersect8(valid, scene_, &context_, group<RTCRayHit8>(g));
        return rtcIntersect16(valid, scene_, &context_, group<RTCRayHit16>(g));
    }
    void stream() {
        const auto count = static_cast<unsigned>(count_);
        if (any_hit_) {
            rtcOccluded1M(scene_, &context_, group<RTCRay>(0), count, rays_.bytes());
        } else {
            rtcIntersect1M(scene_, &context_, group<RTCRayHit>(0), count, rays_.bytes());
        }
    }
    unsigned* ids(Field f) { return reinterpret_cast<unsigned*>(rays_.field(0, f)); }
    void soa_stream() {
        const auto f = [&](Field field) { return rays_.field(0, field); };
        RTCRayHitNp np;
        np.ray = {f(org),  f(Field(org + 1)), f(Field(org + 2)), f(tnear),
                  f(dir),  f(Field(dir + 1)), f(Field(dir + 2)), f(time),
                  f(tfar), ids(mask),         ids(id),           ids(flags)};
        const auto count = static_cast<unsigned>(count_);
        if (any_hit_) return rtcOccludedNp(scene_, &context_, &np.ray, count);
        np.hit = {f(ng), f(Field(ng + 1)), f(Field(ng + 2)), f(u), f(v), ids(prim), ids(geom), {ids(inst)}};
        rtcIntersectNp(scene_, &context_, &np, count);
    }

    const RTCScene scene_;
    const EmbreeFeed feed_;
    const bool any_hit_;
    const size_t width_;
    Groups rays_;
    RTCIntersectContext context_;
    size_t count_ = 0;
};

}  // namespace

std::unique_ptr<Tracer> make_embree_tracer(RTCSceneTy* scene, const EmbreeFeed& feed, bool any_hit, size_t chunk) {
    return std::make_unique<EmbreeTracer>(scene, feed, any_hit, chunk);
}

}  // namespace steradian::bench
