#include <algorithm>
#include <memory>

#include "accel/world.h"
#include "brute_force.h"
#include "hostile.h"
#include "options.h"

namespace steradian::test {
namespace {

/// What the definition says, for every ray of a case.
struct Answers {
    std::vector<Ray> rays;
    std::vector<std::vector<Hit>> all;  ///< in order
    std::vector<Accel::Occlusion> occlusion;

    Hit hit(size_t ray, size_t k) const { return k < all[ray].size() ? all[ray][k] : Hit{}; }
    /// The first one that comes after any hit, of the ray or not.
    Hit next(size_t ray, const Hit& after) const {
        for (const Hit& hit : all[ray])
            if (comes_before(after, hit)) return hit;
        return {};
    }
};

Answers answers(const HostileCase& hostile) {
    const BruteForce brute(hostile.scene);
    Answers out{hostile.rays, {}, {}};
    for (size_t i = 0; i < out.rays.size(); ++i) {
        Ray& ray = out.rays[i];
        out.all.push_back(brute.all_hits(ray));
        if (i % 4 != 3 || out.all[i].empty()) continue;
        // Cut short exactly at a hit, which still counts.
        (i % 8 == 3 ? ray.tmin : ray.tmax) = out.all[i][i % out.all[i].size()].t;
        out.all[i] = brute.all_hits(ray);
    }
    for (const Ray& ray : out.rays) out.occlusion.push_back(brute.occlusion(ray));
    return out;
}

/// One Accel and everything that can be asked of it.
class Interview {
public:
    Interview(const HostileCase& hostile, const Answers& expected, const Accel& accel)
        : hostile_(hostile), expected_(expected), rays_(expected.rays), accel_(accel) {}

    std::string run() {
        for (const RayKind kind : {RayKind::incoherent, RayKind::coherent}) {
            const std::string name = kind == RayKind::coherent ? "coherent" : "incoherent";
            closest(name, [&](std::span<const Ray> rays, std::span<Hit> hits) { accel_.intersect(rays, hits, kind); });
            any(name,
                [&](std::span<const Ray> rays, std::span<uint8_t> result) { accel_.occluded(rays, result, kind); });
        }
        one_by_one();
        continued();
        after_anything();
        return failure_;
    }

private:
    static constexpr size_t kMostContinued = 3;

    /// body(begin, count) for the spans that the case asks for.
    template <class Body>
    void in_batches(Body body) const {
        for (size_t begin = 0, turn = 0; begin < rays_.size(); ++turn) {
            const size_t size = hostile_.batches[turn % hostile_.batches.size()];
            const size_t count = std::min(size, rays_.size() - begin);
            body(begin, count);
            begin += count;
        }
    }
    void fail(const std::string& call, size_t i, const std::string& wanted, const std::string& got) {
        if (failure_.empty())
            failure_ = call + ", ray " + std::to_string(i) + " of " + std::to_string(rays_.size()) + "\nray      " +
                       describe(rays_[i]) + "\nexpected " + wanted + "\ngot      " + got;
    }
    void expect(const std::string& call, size_t i, const Hit& wanted, const Hit& got) {
        if (!same_bits(wanted, got)) fail(call, i, describe(wanted), describe(got));
    }
    void expect(const std::string& call, size_t i, int wanted, int got) {
        if (wanted != got) fail(call, i, std::to_string(wanted), std::to_string(got));
    }

    template <class Call>
    std::vector<Hit> ask(const std::string& name, Call call) {
        const Hit untouched{1, 2, 3, 4, 5};
        std::vector<Hit> hits(rays_.size() + 1, untouched);
        in_batches([&](size_t begin, size_t count) {
            call(begin, std::span(rays_).subspan(begin, count), std::span(hits).subspan(begin, count));
            expect(name + ", behind the span", begin, untouched, hits[begin + count]);
        });
        hits.pop_back();
        return hits;
    }
    template <class Call>
    void closest(const std::string& name, Call call) {
        const std::vector<Hit> hits =
            ask(name, [&](size_t, std::span<const Ray> rays, std::span<Hit> out) { call(rays, out); });
        for (size_t i = 0; i < hits.size(); ++i) expect("intersect, " + name, i, expected_.hit(i, 0), hits[i]);
    }
    template <class Call>
    void any(const std::string& name, Call call) {
        std::vector<uint8_t> result(rays_.size() + 1, 77);
        in_batches([&](size_t begin, size_t count) {
            call(std::span(rays_).subspan(begin, count), std::span(result).subspan(begin, count));
            expect("occluded, behind the span", begin, 77, result[begin + count]);
        });
        for (size_t i = 0; i < rays_.size(); ++i) expect("occluded, " + name, i, expected_.occlusion[i], result[i]);
    }
    void one_by_one() {
        for (size_t i = 0; i < rays_.size(); ++i) {
            expect("intersect, one ray", i, expected_.hit(i, 0), accel_.intersect(rays_[i]));
            expect("occluded, one ray", i, expected_.occlusion[i], accel_.occluded(rays_[i]));
            Hit hit;
            accel_.next_hit({&rays_[i], 1}, {&hostile_.after[i], 1}, {&hit, 1});
            expect("next_hit, one ray", i, expected_.next(i, hostile_.after[i]), hit);
        }
    }
    /// All hits in turn.
    void continued() {
        size_t most = 0;
        for (const auto& hits : expected_.all) most = std::max(most, hits.size());
        for (size_t k = 0; k < std::min(most, kMostContinued); ++k) {
            std::vector<Hit> after;
            for (size_t i = 0; i < rays_.size(); ++i) after.push_back(expected_.hit(i, k));
            next("next_hit, after hit " + std::to_string(k), after, [&](size_t i) { return expected_.hit(i, k + 1); });
        }
    }
    void after_anything() {
        next("next_hit, after anything", hostile_.after,
             [&](size_t i) { return expected_.next(i, hostile_.after[i]); });
    }
    template <class Wanted>
    void next(const std::string& name, const std::vector<Hit>& after, Wanted wanted) {
        const std::vector<Hit> hits = ask(name, [&](size_t begin, std::span<const Ray> rays, std::span<Hit> out) {
            accel_.next_hit(rays, std::span(after).subspan(begin, rays.size()), out);
        });
        for (size_t i = 0; i < hits.size(); ++i) expect(name, i, wanted(i), hits[i]);
    }

    const HostileCase& hostile_;
    const Answers& expected_;
    const std::vector<Ray>& rays_;
    const Accel& accel_;
    std::string failure_;
};

void count(const Answers& expected, HostileCounts& counts) {
    counts.rays += expected.rays.size();
    for (const auto& hits : expected.all) {
        counts.hits += !hits.empty();
        counts.ties += hits.size() > 1 && hits[0].t == hits[1].t;
    }
    for (const Accel::Occlusion o : expected.occlusion) counts.cut_outs += o == Accel::cut_out;
}

}  // namespace

std::string check_hostile_case(const HostileCase& hostile, HostileCounts& counts) {
    const std::vector<Geometry> geometries = hostile.scene.geometries();
    std::optional<std::string> refusal;  // the first one's, which must be everybody's
    std::optional<Answers> expected;
    ++counts.cases;
    size_t turn = counts.cases;
    for (AccelOptions options : all_options()) {
        options.max_depth = hostile.max_depth;
        options.open = turn++ % 2 ? OpenInstances::always : OpenInstances::never;
        const std::string name = describe(options);
        const Result<Accel> accel = Accel::build(geometries, hostile.scene.instances, options);
        const std::string message = accel ? "" : accel.error().message;
        if (!refusal) {
            refusal = message;
            counts.refused += !accel;
        }
        if (message != *refusal) return name + ": '" + message + "', but before '" + *refusal + "'";
        if (!accel) {
            if (accel.error().code != ErrorCode::bad_input) return name + ": " + message;
            continue;
        }
        counts.opened += accel->statistics().instance_parts > 0;
        if (accel->statistics().depth > options.max_depth) return name + ": too deep";
        if (!expected) {
            expected = answers(hostile);
            count(*expected, counts);
        }
        const std::string failure = Interview(hostile, *expected, *accel).run();
        if (!failure.empty()) return name + ": " + failure;
    }
    return {};
}

}  // namespace steradian::test
