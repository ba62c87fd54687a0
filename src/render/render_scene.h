// The immutable thing that jobs render: what shading sees, and the acceleration structure over it.
#pragma once

#include <string>
#include <vector>

#include "accel/accel.h"
#include "shading/shading_scene.h"
#include "steradian/render.h"

namespace steradian {

class RenderScene {
public:
    RenderScene(ShadingScene shading_scene, std::vector<SphereGeometry> spheres,
                std::vector<RectangleGeometry> rectangles, std::vector<DiskGeometry> disks,
                std::vector<uint8_t> cut_outs, Accel accel_in, std::string content_hash)
        : shading(std::move(shading_scene)),
          accel(std::move(accel_in)),
          hash(std::move(content_hash)),
          spheres_(std::move(spheres)),
          rectangles_(std::move(rectangles)),
          disks_(std::move(disks)),
          cut_outs_(std::move(cut_outs)) {}

    ShadingScene shading;
    Accel accel;       ///< instance ids of its hits are indices into shading.scene.instances
    std::string hash;  ///< scene_hash of what was given to prepare

private:
    // The accel refers to these, and to the meshes of the scene.
    std::vector<SphereGeometry> spheres_;
    std::vector<RectangleGeometry> rectangles_;
    std::vector<DiskGeometry> disks_;
    std::vector<uint8_t> cut_outs_;  ///< bits that are 1, for every instance whose primitives may let rays pass
};

}  // namespace steradian
