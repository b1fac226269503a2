// Finds the allowed posture that is closest to a desired one, by IPOPT with exact second derivatives: the
// left hand lays a box onto a table. R starts small and grows (continuation, docs/optimise.md). Run it in
// data/hrp2_style.
#include <fcl/geometry/shape/box.h>

#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>
#include <IpTNLP.hpp>
#include <cstdio>

#include "docs/examples/named.h"
#include "docs/examples/reported.h"
#include "fcl_stpbv/robot/constraints.h"
#include "fcl_stpbv/robot/srdf.h"

using namespace fcl_stpbv;
using Eigen::Map;
using Eigen::VectorXd;

namespace {

/// min |q - wanted|^2 / 2, d(q) >= 0, joints within their limits.
class Closest : public Ipopt::TNLP {
 public:
  Closest(CollisionConstraints& rows, const Kinematics& kinematics, const VectorXd& wanted, VectorXd& q)
      : rows_(rows), kinematics_(kinematics), wanted_(wanted), q_(q), hessian_(rows.makeHessian()) {}

  bool get_nlp_info(int& n, int& m, int& jacobian, int& hessian, IndexStyleEnum& style) override {
    n = rows_.columns();
    m = rows_.rows();
    jacobian = rows_.nonZeros();
    // The cost's diagonal; IPOPT adds entries at the same place.
    hessian = static_cast<int>(hessian_.nonZeros()) + n;
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(int n, double* low, double* high, int m, double* least, double* most) override {
    Map<VectorXd>(low, n) = kinematics_.lower();
    Map<VectorXd>(high, n) = kinematics_.upper();
    std::fill(least, least + m, 0.0);
    std::fill(most, most + m, 1e20);
    return true;
  }
  bool get_starting_point(int n, bool, double* q, bool, double*, double*, int, bool, double*) override {
    Map<VectorXd>(q, n) = q_;
    return true;
  }
  bool eval_f(int n, const double* q, bool, double& cost) override {
    cost = (Map<const VectorXd>(q, n) - wanted_).squaredNorm() / 2;
    return true;
  }
  bool eval_grad_f(int n, const double* q, bool, double* gradient) override {
    Map<VectorXd>(gradient, n) = Map<const VectorXd>(q, n) - wanted_;
    return true;
  }
  bool eval_g(int n, const double* q, bool, int m, double* d) override {
    return rows_.evaluate(Map<const VectorXd>(q, n), Map<VectorXd>(d, m));
  }
  bool eval_jac_g(int n, const double* q, bool, int m, int count, int* row, int* column,
                  double* values) override {
    if (values) {
      VectorXd d(m);
      return rows_.evaluateValues(Map<const VectorXd>(q, n), d, Map<VectorXd>(values, count));
    }
    for (int i = 0; i < m; ++i)
      std::fill(row + rows_.rowStart()[static_cast<std::size_t>(i)],
                row + rows_.rowStart()[static_cast<std::size_t>(i) + 1], i);
    std::copy(rows_.columnIndices().begin(), rows_.columnIndices().end(), column);
    return true;
  }
  bool eval_h(int n, const double* q, bool, double scale, int m, const double* weights, bool, int, int* row,
              int* column, double* values) override {
    const Eigen::Index rowsPart = hessian_.nonZeros();
    if (!values) {
      for (int j = 0; j < n; ++j)
        for (CollisionConstraints::SparseHessian::InnerIterator it(hessian_, j); it; ++it) {
          *row++ = static_cast<int>(it.row());
          *column++ = j;
        }
      for (int j = 0; j < n; ++j) row[j] = column[j] = j;
      return true;
    }
    const bool known = rows_.hessian(Map<const VectorXd>(q, n), Map<const VectorXd>(weights, m), hessian_);
    Map<VectorXd>(values, rowsPart) = Map<const VectorXd>(hessian_.valuePtr(), rowsPart);
    Map<VectorXd>(values + rowsPart, n).setConstant(scale);
    return known;
  }
  void finalize_solution(Ipopt::SolverReturn, int n, const double* q, const double*, const double*, int,
                         const double*, const double*, double, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    q_ = Map<const VectorXd>(q, n);
  }

 private:
  CollisionConstraints& rows_;
  const Kinematics& kinematics_;
  const VectorXd& wanted_;
  VectorXd& q_;
  CollisionConstraints::SparseHessian hessian_;
};

/// The box in the left hand, level at `pose`, as the only body: an STP-BV with the given R.
std::shared_ptr<const RobotGeometry> heldBox(int hand, const Eigen::Isometry3d& pose, double R) {
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back(i & 1 ? 0.07 : -0.07, i & 2 ? 0.05 : -0.05, i & 4 ? 0.03 : -0.03);
  Body box;
  box.link = hand;
  box.name = "box";
  box.pose = pose;
  box.volume = StpBv::build(corners, {0.01, R});
  box.geometry = std::make_shared<StpBvGeometry>(box.volume);
  box.centre = pose * box.volume->centre();
  box.radius = box.volume->enclosingRadius();
  auto geometry = std::make_shared<RobotGeometry>();
  geometry->bodies = {box};
  return geometry;
}

int run() {
  const auto robot = std::make_shared<const RobotModel>(loadUrdf("hrp2_style.urdf"));
  const auto kinematics = std::make_shared<const Kinematics>(robot);
  VectorXd q = kinematics->configuration(loadSrdf("hrp2_style.srdf", *robot).state("half_sitting"));
  const auto set = [&](VectorXd& to, const char* joint, double angle) {
    to[coordinateOf(*kinematics, joint)] = angle;
  };
  set(q, "LARM_JOINT0", -0.6);
  set(q, "LARM_JOINT3", -1.2);
  Kinematics::State state = kinematics->makeState();
  kinematics->forward(q, state);
  const int hand = linkOf(*robot, "LARM_LINK5");
  const Eigen::Isometry3d& at = state.link[static_cast<std::size_t>(hand)];
  const Eigen::Vector3d centre = at * Eigen::Vector3d(0, 0, -0.16);
  const Eigen::Isometry3d pose = at.inverse() * Eigen::Isometry3d(Eigen::Translation3d(centre));
  ConstraintOptions options;
  const fcl::CollisionObjectd table(std::make_shared<fcl::Boxd>(0.6, 0.8, 0.3), Eigen::Matrix3d::Identity(),
                                    centre - Eigen::Vector3d(0, 0, 0.24));
  options.obstacles = {obstacleOf(table, "table")};
  VectorXd wanted = q;  // inside the table
  set(wanted, "LARM_JOINT0", -0.4);
  set(wanted, "LARM_JOINT3", -0.9);

  bool solved = true;
  // clang-format off
for (double R : {0.3, 1.0, 3.0, 10.0}) {             // m; each from the solution before
  CollisionConstraints rows(kinematics, heldBox(hand, pose, R), {{0, 0, true}}, options);
  Ipopt::SmartPtr<Ipopt::IpoptApplication> ipopt = new Ipopt::IpoptApplication();
  ipopt->Options()->SetIntegerValue("print_level", 0);
  ipopt->Options()->SetStringValue("sb", "yes");
  if (R > 0.3)                                       // stay at the rows, with the last barrier
    for (const char* option : {"mu_init", "bound_push", "bound_frac", "slack_bound_push", "slack_bound_frac"})
      ipopt->Options()->SetNumericValue(option, 1e-6);
  ipopt->Initialize();
  Ipopt::SmartPtr<Ipopt::TNLP> closest = new Closest(rows, *kinematics, wanted, q);
  solved = solved && ipopt->OptimizeTNLP(closest) == Ipopt::Solve_Succeeded;
    // clang-format on
    VectorXd d(1);
    rows.evaluate(q, d);
    std::printf("R = %4g m: %2d iterations, distance %.1e m, %.4f rad from the wanted posture\n", R,
                ipopt->Statistics()->IterationCount(), d[0], (q - wanted).norm());
    solved = solved && d[0] >= -1e-7;
  }
  return solved ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) { return reported(argc, argv, run); }
