#pragma once

namespace steradian::bench {

double thread_seconds();   ///< processor time of the calling thread
double process_seconds();  ///< processor time of all threads
double wall_seconds();

}  // namespace steradian::bench
