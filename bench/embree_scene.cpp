#include "embree_scene.h"

#include <embree3/rtcore.h>

#include <cstring>
#include <stdexcept>
#include <string>

namespace steradian::bench {

struct EmbreeScene::Data {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;

    ~Data() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }
};

EmbreeScene::EmbreeScene(const BenchMesh& mesh, bool robust, unsigned threads) : data_(std::make_unique<Data>()) {
    const std::string config = threads ? "threads=" + std::to_string(threads) : "";
    data_->device = rtcNewDevice(config.c_str());
    if (!data_->device) throw std::runtime_error("Embree does not start");
    data_->scene = rtcNewScene(data_->device);
    if (robust) rtcSetSceneFlags(data_->scene, RTC_SCENE_FLAG_ROBUST);
    const RTCGeometry geometry = rtcNewGeometry(data_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* positions = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3),
                                              mesh.positions.size());
    std::memcpy(positions, mesh.positions.data(), mesh.positions.size() * sizeof(Vec3));
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t),
                                            mesh.triangles());
    std::memcpy(indices, mesh.indices.data(), mesh.indices.size() * sizeof(uint32_t));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(data_->scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(data_->scene);
}
EmbreeScene::~EmbreeScene() = default;
EmbreeScene::EmbreeScene(EmbreeScene&&) noexcept = default;

void EmbreeScene::intersect(std::span<const Ray> rays, std::span<Hit> hits) const {
    for (size_t i = 0; i < rays.size(); ++i) {
        const Ray& r = rays[i];
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit query;
        query.ray = {r.o.x, r.o.y, r.o.z, r.tmin, r.d.x, r.d.y, r.d.z, 0, r.tmax, ~0u, 0, 0};
        query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(data_->scene, &context, &query);
        hits[i] = query.hit.geomID == RTC_INVALID_GEOMETRY_ID
                      ? Hit{}
                      : Hit{query.ray.tfar, query.hit.u, query.hit.v, query.hit.primID, 0};
    }
}

void EmbreeScene::occluded(std::span<const Ray> rays, std::span<uint8_t> result) const {
    for (size_t i = 0; i < rays.size(); ++i) {
        const Ray& r = rays[i];
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRay query{r.o.x, r.o.y, r.o.z, r.tmin, r.d.x, r.d.y, r.d.z, 0, r.tmax, ~0u, 0, 0};
        rtcOccluded1(data_->scene, &context, &query);
        result[i] = query.tfar < 0;
    }
}

}  // namespace steradian::bench
