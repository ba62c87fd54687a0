#include "ours.h"

#include <algorithm>

namespace steradian::bench {
namespace {

AccelOptions with(BvhBuilder builder, BvhLayout layout = BvhLayout::full) {
    AccelOptions options;
    options.builder = builder;
    options.layout = layout;
    return options;
}

class OurTracer : public Tracer {
public:
    OurTracer(const Accel& accel, const RaySet& set, size_t chunk)
        : accel_(accel), set_(set), rays_(chunk), hits_(chunk), occluded_(chunk) {}
    void load(std::span<const Ray> rays) override {
        count_ = rays.size();
        std::copy(rays.begin(), rays.end(), rays_.begin());
    }
    void store(std::span<Hit> hits) override { std::copy_n(hits_.begin(), count_, hits.begin()); }
    void store(std::span<uint8_t> occluded) override { std::copy_n(occluded_.begin(), count_, occluded.begin()); }

protected:
    std::span<const Ray> rays() const { return std::span(rays_).first(count_); }
    std::span<Hit> hits() { return std::span(hits_).first(count_); }
    std::span<uint8_t> occluded() { return std::span(occluded_).first(count_); }

    const Accel& accel_;
    const RaySet& set_;

private:
    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
    std::vector<uint8_t> occluded_;
    size_t count_ = 0;
};

class BatchTracer : public OurTracer {
public:
    using OurTracer::OurTracer;
    void trace() override {
        const RayKind kind = set_.coherent ? RayKind::coherent : RayKind::incoherent;
        if (set_.any_hit) {
            accel_.occluded(rays(), occluded(), kind);
        } else {
            accel_.intersect(rays(), hits(), kind);
        }
    }
};

class SingleTracer : public OurTracer {
public:
    using OurTracer::OurTracer;
    void trace() override {
        for (size_t i = 0; i < rays().size(); ++i) {
            if (set_.any_hit) {
                occluded()[i] = accel_.occluded(rays()[i]);
            } else {
                hits()[i] = accel_.intersect(rays()[i]);
            }
        }
    }
};

}  // namespace

const std::vector<OurSetting>& our_settings() {
    static const std::vector<OurSetting> settings = {{"sah", with(BvhBuilder::sah)},
                                                     {"median", with(BvhBuilder::median)},
                                                     {"fast", with(BvhBuilder::fast)},
                                                     {"high-quality", with(BvhBuilder::high_quality)},
                                                     {"compact", with(BvhBuilder::sah, BvhLayout::compact)}};
    return settings;
}

Result<Accel> build_ours(const BenchMesh& mesh, const OurSetting& setting) {
    const Geometry geometry = mesh.geometry();
    const GeometryInstance instance;
    return Accel::build({&geometry, 1}, {&instance, 1}, setting.options);
}

MakeTracer our_batches(const Accel& accel) {
    return [&accel](const RaySet& set, size_t chunk) { return std::make_unique<BatchTracer>(accel, set, chunk); };
}

MakeTracer our_single_rays(const Accel& accel) {
    return [&accel](const RaySet& set, size_t chunk) { return std::make_unique<SingleTracer>(accel, set, chunk); };
}

}  // namespace steradian::bench
