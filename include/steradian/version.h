// The version of the library, read by the build as well: the one place where it is written.
#pragma once

#define STERADIAN_VERSION_MAJOR 0
#define STERADIAN_VERSION_MINOR 1
#define STERADIAN_VERSION_PATCH 0
#define STERADIAN_VERSION "0.1.0"
