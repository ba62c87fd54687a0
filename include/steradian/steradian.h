// The whole public API of Steradian.
#pragma once

#include "steradian/image.h"     // IWYU pragma: export
#include "steradian/image_io.h"  // IWYU pragma: export
#include "steradian/lint.h"      // IWYU pragma: export
#include "steradian/load.h"      // IWYU pragma: export
#include "steradian/render.h"    // IWYU pragma: export
#include "steradian/replay.h"    // IWYU pragma: export
#include "steradian/result.h"    // IWYU pragma: export
#include "steradian/scene.h"     // IWYU pragma: export
#include "steradian/settings.h"  // IWYU pragma: export
#include "steradian/vec.h"       // IWYU pragma: export
#include "steradian/version.h"   // IWYU pragma: export
