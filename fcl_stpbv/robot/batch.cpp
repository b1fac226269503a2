// Threads take pieces of a batch, some columns each, until none is left. A piece always starts without a
// cache, so the results do not depend on the thread that computes it.
#include "fcl_stpbv/robot/batch.h"

#include <algorithm>
#include <atomic>
#include <string>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/robot/worker_pool.h"

namespace fcl_stpbv {
namespace {

using Eigen::Index;

void requireSize(Index rows, Index columns, Index wantedRows, Index wantedColumns, const char* what) {
  if (rows == wantedRows && columns == wantedColumns) return;
  const auto size = [](Index m, Index n) { return std::to_string(m) + " x " + std::to_string(n); };
  throw Error(std::string("a batch's ") + what + ": got " + size(rows, columns) + ", expected " +
              size(wantedRows, wantedColumns));
}

int checkedThreads(int threads) {
  constexpr int kMost = 256;  // each thread has a copy of all rows
  if (threads < 1 || threads > kMost)
    throw Error("a batch's threads: got " + std::to_string(threads) + ", expected 1 to " +
                std::to_string(kMost));
  return threads;
}

/// One worker for each thread. All are copies of the first.
template <class Worker>
class Crew {
 public:
  Crew(const Worker& first, int threads)
      : pool_(checkedThreads(threads)), workers_(static_cast<std::size_t>(pool_.threads()), first) {}

  Worker& first() { return workers_.front(); }

  /// Calls `work(worker, column)` for each column of a batch. A worker remembers the column before it only on
  /// a path, and only within one piece.
  template <class Work>
  void each(Index columns, Sequence sequence, const Work& work) {
    // Pieces are small enough to share out evenly; a path's first column costs some more.
    const Index pieces = (columns + kBatchPiece - 1) / kBatchPiece;
    pool_.share(static_cast<std::size_t>(pieces), [&](int k, std::size_t piece) {
      Worker& worker = workers_[static_cast<std::size_t>(k)];
      const Index start = static_cast<Index>(piece) * kBatchPiece;
      for (Index column = start; column < std::min(start + kBatchPiece, columns); ++column) {
        if (column == start || sequence == Sequence::independent) worker.forget();
        work(worker, column);
      }
    });
  }

 private:
  detail::WorkerPool pool_;
  std::vector<Worker> workers_;
};

}  // namespace

class ConstraintsBatch::Impl : public Crew<CollisionConstraints> {
 public:
  using Crew::Crew;
};

ConstraintsBatch::ConstraintsBatch(const CollisionConstraints& constraints, int threads)
    : impl_(std::make_unique<Impl>(constraints, threads)) {}
ConstraintsBatch::ConstraintsBatch(ConstraintsBatch&&) noexcept = default;
ConstraintsBatch& ConstraintsBatch::operator=(ConstraintsBatch&&) noexcept = default;
ConstraintsBatch::~ConstraintsBatch() = default;

bool ConstraintsBatch::compute(const Configurations& q, Sequence sequence, Matrix d, Matrix* values) {
  CollisionConstraints& first = impl_->first();
  requireSize(q.rows(), q.cols(), first.columns(), q.cols(), "configurations");
  requireSize(d.rows(), d.cols(), first.rows(), q.cols(), "distances");
  if (values) requireSize(values->rows(), values->cols(), first.nonZeros(), q.cols(), "values of J");
  const auto valuesAt = [&](Index i) { return values ? values->col(i).data() : nullptr; };
  std::atomic<bool> finite{true};
  impl_->each(q.cols(), sequence, [&](CollisionConstraints& rows, Index i) {
    if (!rows.computePairs(q.col(i), d.col(i).data(), valuesAt(i))) finite = false;
  });
  // Smooth constraints are called from one thread at a time.
  for (Index i = 0; i < q.cols(); ++i)
    if (q.col(i).allFinite()) first.computeSmooth(q.col(i), d.col(i).data(), valuesAt(i));
  return finite;
}

bool ConstraintsBatch::evaluate(const Configurations& q, Sequence sequence, Matrix d) {
  return compute(q, sequence, d, nullptr);
}

bool ConstraintsBatch::evaluateValues(const Configurations& q, Sequence sequence, Matrix d, Matrix values) {
  return compute(q, sequence, d, &values);
}

class CheckerBatch::Impl : public Crew<CollisionChecker> {
 public:
  using Crew::Crew;
};

CheckerBatch::CheckerBatch(const CollisionChecker& checker, int threads)
    : impl_(std::make_unique<Impl>(checker, threads)) {}
CheckerBatch::CheckerBatch(CheckerBatch&&) noexcept = default;
CheckerBatch& CheckerBatch::operator=(CheckerBatch&&) noexcept = default;
CheckerBatch::~CheckerBatch() = default;

void CheckerBatch::collides(const Configurations& q, Sequence sequence, Verdicts hit) {
  requireSize(q.rows(), q.cols(), impl_->first().kinematics().size(), q.cols(), "configurations");
  requireSize(hit.size(), 1, q.cols(), 1, "verdicts");
  impl_->each(q.cols(), sequence,
              [&](CollisionChecker& checker, Index i) { hit[i] = checker.collides(q.col(i)); });
}

void CheckerBatch::minDistance(const Configurations& q, Sequence sequence,
                               Eigen::Ref<Eigen::VectorXd> least) {
  requireSize(q.rows(), q.cols(), impl_->first().kinematics().size(), q.cols(), "configurations");
  requireSize(least.size(), 1, q.cols(), 1, "least distances");
  impl_->each(q.cols(), sequence,
              [&](CollisionChecker& checker, Index i) { least[i] = checker.minDistance(q.col(i)); });
}

}  // namespace fcl_stpbv
