// What integrators tell about a sample while it is replayed. Pictures are rendered without one.
#pragma once

#include <new>

#include "steradian/replay.h"

namespace steradian {

/// One sample at a time. Integrators must not throw, so running out of memory is a flag.
class Recorder {
public:
    void camera(Vec2 film, float filter_weight) noexcept {
        trace_.film = film;
        trace_.filter_weight = filter_weight;
    }
    void vertex(TracedVertex vertex) noexcept {
        guarded([&] { trace_.vertices.push_back(std::move(vertex)); });
    }
    /// Of the last vertex, as are the next four.
    void emission(Rgb radiance, float bsdf_pdf, float light_pdf, float mis_weight, Rgb contribution) noexcept {
        if (failed_) return;
        TracedVertex& v = trace_.vertices.back();
        // Of several lights on top of each other, a sun in the sky, the densities are those of the last.
        v.emission = v.emission + radiance, v.bsdf_pdf = bsdf_pdf, v.light_pdf = light_pdf;
        v.mis_weight = mis_weight, v.contribution = v.contribution + contribution;
    }
    void light(TracedLight light) noexcept {
        guarded([&] { trace_.vertices.back().lights.push_back(std::move(light)); });
    }
    void bounce(const TracedBounce& bounce) noexcept {
        if (!failed_) trace_.vertices.back().bounce = bounce;
    }
    void wavelength(float nanometres, Rgb weight) noexcept {
        if (failed_) return;
        trace_.vertices.back().wavelength = nanometres;
        trace_.vertices.back().wavelength_weight = weight;
    }
    /// How much of the light passes the next shadow ray, in the order in which they were told of.
    void shadow(float passes) noexcept {
        if (failed_) return;
        for (; answered_vertex_ < trace_.vertices.size(); ++answered_vertex_, answered_light_ = 0) {
            auto& lights = trace_.vertices[answered_vertex_].lights;
            while (answered_light_ < lights.size() && !lights[answered_light_].shadow_ray) ++answered_light_;
            if (answered_light_ == lights.size()) continue;
            TracedLight& light = lights[answered_light_++];
            light.occluded = passes == 0;
            if (passes > 0 && passes < 1) light.contribution = light.contribution * passes;
            return;
        }
    }
    void finish(Rgb radiance, bool bad) noexcept {
        trace_.radiance = radiance;
        trace_.bad = bad;
    }

    bool failed() const noexcept { return failed_; }
    SampleTrace& trace() noexcept { return trace_; }

private:
    template <class Action>
    void guarded(Action action) noexcept {
        if (failed_) return;
        try {
            action();
        } catch (const std::bad_alloc&) {
            failed_ = true;
        }
    }

    SampleTrace trace_;
    size_t answered_vertex_ = 0, answered_light_ = 0;
    bool failed_ = false;
};

}  // namespace steradian
