#include "shading/interior.h"

#include "math/elementary.h"
#include "shading/shading_scene.h"

namespace steradian {
namespace {

const Dielectric& body_of(const ShadingScene& scene, uint32_t material) {
    return *scene.materials[material].dielectric;
}

double extinction(const Medium& medium, int channel) {
    return static_cast<double>(medium.absorption[channel]) + medium.scattering[channel];
}

double left_after(double coefficient, double distance) {
    return coefficient > 0 ? math::exp(-coefficient * distance) : 1;
}

/// How often each channel decides.
struct ChannelShares {
    double of[3];
    explicit ChannelShares(Rgb throughput) {
        const double sum = static_cast<double>(throughput.r) + throughput.g + throughput.b;
        for (int c = 0; c < 3; ++c) of[c] = sum > 0 ? throughput[c] / sum : 1.0 / 3;
    }
};

}  // namespace

bool covers(const ShadingScene& scene, uint32_t first, uint32_t second) noexcept {
    const uint32_t a = *body_of(scene, first).priority, b = *body_of(scene, second).priority;
    return a != b ? a > b : first < second;
}

uint32_t Interior::find(uint32_t material) const noexcept {
    uint32_t i = 0;
    while (i < count_ && bodies_[i].material != material) ++i;
    return i;
}

void Interior::enter(const ShadingScene& scene, uint32_t material) noexcept {
    if (const uint32_t known = find(material); known < count_) {
        ++bodies_[known].times;
        return;
    }
    if (count_ == kMost) return;
    uint32_t place = count_;
    if (body_of(scene, material).priority)
        while (place > 0 && body_of(scene, bodies_[place - 1].material).priority &&
               covers(scene, bodies_[place - 1].material, material))
            --place;
    for (uint32_t i = count_; i > place; --i) bodies_[i] = bodies_[i - 1];
    bodies_[place] = {material};
    ++count_;
}

void Interior::leave(uint32_t material) noexcept {
    const uint32_t place = find(material);
    if (place == count_ || --bodies_[place].times > 0) return;
    --count_;
    for (uint32_t i = place; i < count_; ++i) bodies_[i] = bodies_[i + 1];
}

float Interior::index(const ShadingScene& scene) const noexcept {
    float out = 1;
    for (uint32_t i = 0; i < count_; ++i) {
        const Dielectric& body = body_of(scene, bodies_[i].material);
        out = body.priority ? body.eta : out * body.eta;
    }
    return out;
}

const Medium* Interior::medium(const ShadingScene& scene) const noexcept {
    return count_ > 0 ? &body_of(scene, filling()).medium : nullptr;
}

Rgb transmittance(const Medium& medium, double distance) noexcept {
    Rgb out;
    for (int c = 0; c < 3; ++c) out[c] = static_cast<float>(left_after(extinction(medium, c), distance));
    return out;
}

double sample_scattering(const Medium& medium, Rgb throughput, Vec2 u) noexcept {
    const ChannelShares share(throughput);
    int channel = 0;
    double left = u.x;
    while (channel < 2 && left >= share.of[channel]) left -= share.of[channel++];
    const double coefficient = extinction(medium, channel);
    return coefficient > 0 ? -math::log(1 - static_cast<double>(u.y)) / coefficient : double{kInfinity};
}

Rgb scattering_weight(const Medium& medium, Rgb throughput, double distance, bool scattered) noexcept {
    const ChannelShares share(throughput);
    double numerator[3], density = 0;
    for (int c = 0; c < 3; ++c) {
        const double coefficient = extinction(medium, c), left = left_after(coefficient, distance);
        numerator[c] = scattered ? medium.scattering[c] * left : left;
        density += share.of[c] * (scattered ? coefficient * left : left);
    }
    Rgb out;
    for (int c = 0; c < 3; ++c) out[c] = density > 0 ? static_cast<float>(numerator[c] / density) : 0.0f;
    return out;
}

}  // namespace steradian
