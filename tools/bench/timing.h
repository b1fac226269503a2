// Methods timed side by side: blocks of queries on the same poses, the methods taking turns, so that whatever
// else the machine does hits all of them alike.
#pragma once

#include <functional>
#include <vector>

#include "test/reference/motion.h"
#include "tools/bench/measurement.h"
#include "tools/bench/method.h"

namespace fcl_stpbv::benchmark {

/// Half the middle half of the values, relative to their median: how far repeated blocks disagree.
double spread(std::vector<double> values);

/// Blocks that disagree by more than this say that the machine was busy with something else.
constexpr double kQuietSpread = 0.15;

/// One method's times.
struct Times {
  std::vector<double> block;  ///< ns a query, one value a block; the thread's own time
  std::vector<double> query;  ///< ns, one value a query, the clock's own time taken off; only if asked for
};

/// Sees each method's answers to a block, after the clock stopped.
using Watch = std::function<void(std::size_t method, const Poses&, const std::vector<Answer>&)>;

/// Runs `blocks` blocks of `length` queries. Within a block each method answers all of its poses; the order
/// of the methods is turned round from block to block. A first block is not counted. A method that
/// has spent more than `seconds` answers no further block.
std::vector<Times> timed(const std::vector<MethodPtr>& methods, GeodesicMotion& motion, int blocks,
                         int length, bool everyQuery = false, const Watch& watch = {}, double seconds = 1e9);

}  // namespace fcl_stpbv::benchmark
