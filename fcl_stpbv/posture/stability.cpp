// Static stability: in the projection along z, the centre of mass is a convex combination of the contacts'
// corners, which are moved inwards by the margin (support_patch.h). A disc with the margin as its radius
// around each such corner lies in its contact. So a disc around each convex combination of them lies in the
// support polygon.
#include <utility>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/posture/support_patch.h"
#include "fcl_stpbv/posture/task.h"
#include "fcl_stpbv/posture/task_start.h"
#include "fcl_stpbv/robot/link_check.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Constraints that keep the projections of the contacts wide enough for the margin.
class ContactRoom : public PostureRows {
 public:
  ContactRoom(std::shared_ptr<const Kinematics> kinematics, const std::vector<int>& links,
              std::vector<SupportPatch> patches, const Eigen::Matrix3d& world)
      : kinematics_(std::move(kinematics)), links_(links), patches_(std::move(patches)), world_(world) {
    for (std::size_t c = 0; c < links.size(); ++c) {
      carriers_.push_back(kinematics_->dependence(links[c]));
      for (int room = 0; room < patches_[c].rooms(); ++room) rows_.push_back({c, room});
    }
  }

  Kind kind() const override { return Kind::atLeast; }
  int size() const override { return static_cast<int>(rows_.size()); }
  std::string name(int row) const override {
    return (rows_[at(row)].room == 0 ? "stability margin within " : "steepness of the contact of ") +
           kinematics_->robot().links[at(links_[rows_[at(row)].contact])].name;
  }
  std::string unit(int row) const override { return rows_[at(row)].room == 0 ? "m" : ""; }

  void evaluate(const Point& point, Eigen::Ref<Eigen::VectorXd> values,
                Eigen::Ref<RowMatrix> jacobian) override {
    int row = 0;
    for (std::size_t c = 0; c < patches_.size(); ++c) {
      patches_[c].place(point.state.link[at(links_[c])], world_);
      for (int k = 0; k < patches_[c].rooms(); ++k, ++row) {
        values[row] = patches_[c].room(k);
        for (const Kinematics::Dependence& d : carriers_[c])
          jacobian(row, kinematics_->motions()[at(d.motion)].coordinate) +=
              patches_[c].roomRate(k, point.state.motion[at(d.motion)]);
      }
    }
  }

 private:
  std::shared_ptr<const Kinematics> kinematics_;
  std::vector<int> links_;
  std::vector<SupportPatch> patches_;
  Eigen::Matrix3d world_;
  std::vector<std::vector<Kinematics::Dependence>> carriers_;
  struct Row {
    std::size_t contact;
    int room;  // of the contact's patch
  };
  std::vector<Row> rows_;
};

}  // namespace

std::vector<Vector3d> shrunk(const std::vector<Vector3d>& points, double margin) {
  return SupportPatch(points, margin).flatCorners();
}

struct StaticStability::Patches {
  std::vector<int> links;
  std::vector<SupportPatch> list;
};

StaticStability::StaticStability(std::shared_ptr<const Kinematics> kinematics,
                                 const std::vector<Contact>& contacts, double margin, int firstWeight,
                                 const Eigen::Matrix3d& world)
    : kinematics_(std::move(kinematics)),
      centre_(*kinematics_),
      patches_(std::make_shared<Patches>()),
      world_(world),
      firstWeight_(firstWeight),
      centreJacobian_(3, kinematics_->size()) {
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const Contact& contact = contacts[c];
    detail::requireLink("StaticStability", contact.link, kinematics_->robot());
    patches_->links.push_back(contact.link);
    patches_->list.push_back(
        within("contacts[" + std::to_string(c) + "]", [&] { return SupportPatch(contact.points, margin); }));
    weights_ += patches_->list.back().corners();
    carriers_.push_back(kinematics_->dependence(contact.link));
  }
  if (weights_ == 0) throw Error("there are no contacts; give some points of some links");
}

std::shared_ptr<PostureRows> StaticStability::room() const {
  auto rows = std::make_shared<ContactRoom>(kinematics_, patches_->links, patches_->list, world_);
  return rows->size() > 0 ? rows : nullptr;
}

std::string StaticStability::name(int row) const {
  static const char* const kNames[] = {"stability x", "stability y", "stability weights"};
  return kNames[row];
}

void StaticStability::evaluate(const Point& point, Eigen::Ref<Eigen::VectorXd> values,
                               Eigen::Ref<RowMatrix> jacobian) {
  const Vector2d centre = (world_ * centre_.evaluate(point.state, centreJacobian_)).head<2>();
  values << 0, 0, -1;
  int weight = firstWeight_;
  for (std::size_t c = 0; c < patches_->list.size(); ++c) {
    SupportPatch& patch = patches_->list[c];
    patch.place(point.state.link[at(patches_->links[c])], world_);
    for (int k = 0; k < patch.corners(); ++k, ++weight) {
      // The corners are seen from the centre of mass. So an error in the sum of the weights is not multiplied
      // by the distance from the origin.
      const Vector2d away = centre - patch.corner(k);
      values.head<2>() += point.x[weight] * away;
      values[2] += point.x[weight];
      jacobian.col(weight).head<3>() << away, 1;
      for (const Kinematics::Dependence& d : carriers_[c])
        jacobian.col(kinematics_->motions()[at(d.motion)].coordinate).head<2>() -=
            point.x[weight] * patch.cornerRate(k, point.state.motion[at(d.motion)]);
    }
  }
  jacobian.topLeftCorner(2, kinematics_->size()) += (values[2] + 1) * (world_.topRows<2>() * centreJacobian_);
}

}  // namespace fcl_stpbv
