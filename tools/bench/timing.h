// Times methods side by side: blocks of queries on the same poses. The methods take turns, so that other work
// of the machine affects all of them alike.
#pragma once

#include <functional>
#include <vector>

#include "test/reference/motion.h"
#include "tools/bench/measurement.h"
#include "tools/bench/method.h"

namespace fcl_stpbv::benchmark {

/// Half the interquartile range of the values, relative to their median: how much repeated blocks differ.
double spread(std::vector<double> values);

/// If blocks differ by more than this, the machine was busy with other work.
constexpr double kQuietSpread = 0.15;

/// One method's times.
struct Times {
  std::vector<double> block;  ///< ns per query, one value per block; the thread's processor time
  /// Times in ns, one value per query, without the time of reading the clock; only if requested.
  std::vector<double> query;
};

/// Receives each method's answers to a block, after the clock was stopped.
using Watch = std::function<void(std::size_t method, const Poses&, const std::vector<Answer>&)>;

/// Runs `blocks` blocks of `length` queries. Within a block each method answers all poses. The order of the
/// methods is reversed from block to block. The first block is not counted. A method that has spent more than
/// `seconds` answers no further blocks.
std::vector<Times> timed(const std::vector<MethodPtr>& methods, GeodesicMotion& motion, int blocks,
                         int length, bool everyQuery = false, const Watch& watch = {}, double seconds = 1e9);

}  // namespace fcl_stpbv::benchmark
