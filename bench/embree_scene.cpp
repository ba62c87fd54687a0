#include <embree3/rtcore.h>

#include <stdexcept>

#include "clock.h"
#include "embree.h"
#include "embree_tracer.h"

namespace steradian::bench {
namespace {

RTCGeometry triangles(RTCDevice device, const BenchMesh& mesh) {
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions.data(), 0,
                               sizeof(Vec3), mesh.positions.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices.data(), 0,
                               3 * sizeof(uint32_t), mesh.triangles());
    rtcCommitGeometry(geometry);
    return geometry;
}

}  // namespace

std::string EmbreeBuild::str() const { return isa + (high ? " high" : " medium") + (robust ? " robust" : ""); }

std::string EmbreeFeed::str() const {
    const std::string flag = coherent ? " coherent" : "";
    switch (kind) {
        case Kind::single:
            return "1";
        case Kind::packet:
            return std::to_string(width) + flag;
        case Kind::stream:
            return "1M" + flag;
        case Kind::soa_stream:
            return "Np" + flag;
    }
    return {};
}

std::vector<std::string> embree_isas() {
    std::vector<std::string> isas;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("sse4.2")) isas.emplace_back("sse4.2");
    if (__builtin_cpu_supports("avx")) isas.emplace_back("avx");
    if (__builtin_cpu_supports("avx2")) isas.emplace_back("avx2");
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl")) isas.emplace_back("avx512");
#else
    isas.emplace_back("default");
#endif
    return isas;
}

EmbreeScene::EmbreeScene(const BenchMesh& mesh, const EmbreeBuild& build, uint32_t threads) {
    std::string config = build.isa == "default" ? "" : "isa=" + build.isa;
    if (threads) config += ",threads=" + std::to_string(threads);
    device_ = rtcNewDevice(config.c_str());
    if (!device_) throw std::runtime_error("Embree does not start with " + config);
    rtcSetDeviceMemoryMonitorFunction(
        device_, [](void* self, ssize_t bytes, bool) { return static_cast<EmbreeScene*>(self)->count_memory(bytes); },
        this);
    const double wall = bench::wall_seconds(), cpu = process_seconds();
    scene_ = rtcNewScene(device_);
    rtcSetSceneBuildQuality(scene_, build.high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM);
    if (build.robust) rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    const RTCGeometry geometry = triangles(device_, mesh);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
    wall_seconds_ = bench::wall_seconds() - wall;
    cpu_seconds_ = process_seconds() - cpu;
    if (const RTCError error = rtcGetDeviceError(device_)) {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
        throw std::runtime_error("Embree cannot build with " + config + ": error " + std::to_string(int(error)));
    }
}

EmbreeScene::~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

bool EmbreeScene::count_memory(int64_t bytes) {
    const int64_t now = bytes_ += bytes;
    int64_t peak = peak_bytes_;
    while (now > peak && !peak_bytes_.compare_exchange_weak(peak, now)) {
    }
    return true;
}

std::vector<EmbreeFeed> EmbreeScene::feeds(bool coherent) const {
    const auto has = [&](RTCDeviceProperty property) { return rtcGetDeviceProperty(device_, property) != 0; };
    using Kind = EmbreeFeed::Kind;
    std::vector<EmbreeFeed> plain;
    if (has(RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED)) plain.push_back({Kind::packet, 4});
    if (has(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED)) plain.push_back({Kind::packet, 8});
    if (has(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) plain.push_back({Kind::packet, 16});
    if (has(RTC_DEVICE_PROPERTY_RAY_STREAM_SUPPORTED)) {
        plain.push_back({Kind::stream});
        plain.push_back({Kind::soa_stream});
    }
    std::vector<EmbreeFeed> all = {{Kind::single}};
    for (EmbreeFeed feed : plain) {
        all.push_back(feed);
        feed.coherent = true;
        if (coherent) all.push_back(feed);
    }
    return all;
}

MakeTracer EmbreeScene::tracer(const EmbreeFeed& feed) const {
    return [scene = scene_, feed](const RaySet& set, size_t chunk) {
        return make_embree_tracer(scene, feed, set.any_hit, chunk);
    };
}

}  // namespace steradian::bench
