// The loop over everything that is always right.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scenes.h"

namespace steradian::test {

/// The definition of a hit, literally: every candidate of every primitive of every instance, in order.
class BruteForce {
public:
    explicit BruteForce(const TestScene& scene);
    ~BruteForce();
    std::vector<Hit> all_hits(const Ray& ray) const;
    Hit first_hit(const Ray& ray) const;
    Accel::Occlusion occlusion(const Ray& ray) const;

private:
    template <class Sink>
    void each(const Ray& ray, Sink sink) const;
    struct Data;
    std::unique_ptr<Data> data_;
};

/// Every bit of every member.
bool same_bits(const Hit& a, const Hit& b);
std::string describe(const Ray& ray);
std::string describe(const Hit& hit);

}  // namespace steradian::test
