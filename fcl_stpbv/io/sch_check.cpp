// Checks the redundant data of a file in sch-core's format for consistency; see sch_data.h.
//
// Tolerances follow from the number of digits in the file: a number x has an error of up to `rounding() |x|`.
// Each check below propagates these errors to the length that it compares. kSlack covers sums of a few such
// errors and the less accurate arithmetic of other writers.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/sch_data.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/vector_hash.h"

namespace fcl_stpbv::detail::sch {
namespace {

using Eigen::Vector3d;
using Triangle = std::array<int, 3>;

constexpr double kSlack = 8;

class Checker {
 public:
  explicit Checker(const File& file) : file_(file), eps_(kSlack * file.rounding()), rho_(file.R - file.r) {}

  std::vector<Triangle> run() {
    countThings();
    for (const Vertex& vertex : file_.vertices) checkSphere(vertex.line, "vertex", vertex.radius, file_.r);
    findCorners();
    for (std::size_t f = 0; f < file_.faces.size(); ++f) checkFace(f);
    for (const Torus& torus : file_.tori) checkTorus(torus);
    for (std::size_t f = 0; f < file_.faces.size(); ++f) checkSides(f);
    checkCount();
    toriAt_.assign(file_.vertices.size(), 0);
    for (const Torus* torus : real_)
      for (const Border& cone : torus->cone) ++toriAt_[static_cast<Size>(cone.id)];
    for (int v = 0; v < vertexCount(); ++v) checkCones(v);
    return corners_;
  }

 private:
  using Size = std::size_t;

  void require(bool holds, int line, const std::string& message) const {
    if (!holds) file_.fail(line, message);
  }

  const Vector3d& vertex(int i) const { return file_.vertices[static_cast<Size>(i)].centre; }
  int vertexCount() const { return file_.firstFace(); }
  bool isFace(int id) const { return id >= file_.firstFace() && id < file_.firstTorus(); }
  const Face& face(int id) const { return file_.faces[static_cast<Size>(id - file_.firstFace())]; }
  bool isTorus(int id) const {
    return id >= file_.firstTorus() && id < file_.firstTorus() + static_cast<int>(real_.size());
  }
  const Torus& torus(int id) const { return *real_[static_cast<Size>(id - file_.firstTorus())]; }

  void countThings() {
    const Size v = file_.vertices.size(), f = file_.faces.size(), t = file_.tori.size();
    require(v >= 3 && f >= 2, 1,
            "fewer than 3 vertices or 2 faces, which this format cannot hold; use .stpbv");
    require(3 * f == 2 * t, 1,
            std::to_string(f) + " triangles and " + std::to_string(t) +
                " tori do not fit, expected three tori for two triangles");
    require(v + f == t + 2, 1,
            "vertices - tori + faces is " + std::to_string(static_cast<long>(v + f) - static_cast<long>(t)) +
                ", expected 2 as for every closed surface");
    for (const Torus& torus : file_.tori) {
      if (torus.real) real_.push_back(&torus);
    }
  }

  void checkSphere(int line, const char* what, double radius, double expected) const {
    require(std::abs(radius - expected) <= eps_ * expected, line,
            std::string("the ") + what + " sphere's radius is " + toDecimal(radius) +
                ", expected that of line 1, " + toDecimal(expected));
  }

  void checkUnit(int line, const Vector3d& axis) const {
    require(std::abs(axis.norm() - 1) <= eps_, line,
            "an axis of length " + toDecimal(axis.norm()) + ", expected a unit vector");
  }

  // Faces repeat their vertices' coordinates instead of their ids.
  void findCorners() {
    std::unordered_map<Vector3d, int, VectorHash> index;
    for (int v = 0; v < vertexCount(); ++v) {
      const bool isNew = index.emplace(vertex(v), v).second;
      require(isNew, file_.vertices[static_cast<Size>(v)].line, "the vertex is in the file twice");
    }
    for (const Face& face : file_.faces) {
      Triangle triangle{};
      for (Size k = 0; k < 3; ++k) {
        const auto found = index.find(face.corner[k]);
        require(found != index.end(), face.line,
                "vertex " + std::to_string(k + 1) + " of the face is none of the file's vertices");
        triangle[k] = found->second;
      }
      require(triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0],
              face.line, "the face names a vertex twice");
      corners_.push_back(triangle);
    }
  }

  // How far a correct vertex may seem to be off a face's sphere.
  double sphereError(const Vector3d& p, const Vector3d& centre) const {
    return eps_ * (p.norm() + centre.norm() + file_.R);
  }

  // How far a correct direction may seem to be turned, if it is computed from points `fromOrigin` from the
  // origin and `length` apart.
  double turnError(double fromOrigin, double length) const { return eps_ * (1 + fromOrigin / length); }

  void checkFace(Size f) const {
    const Face& face = file_.faces[f];
    checkSphere(face.line, "face", face.radius, file_.R);
    double size = 0;
    for (Size k = 0; k < 3; ++k) {
      const Vector3d& p = face.corner[k];
      const double off = (p - face.centre).norm() - rho_;
      require(std::abs(off) <= sphereError(p, face.centre), face.line,
              "vertex " + std::to_string(k + 1) + " of the face is " + toDecimal(off) +
                  " m off the ball of radius R - r around the face's centre");
      size = std::max(size, p.norm());
    }
    const Vector3d side = face.corner[1] - face.corner[0], other = face.corner[2] - face.corner[0];
    const double longest = std::max({side.norm(), other.norm(), (side - other).norm()});
    const double outward = side.cross(other).dot(face.corner[0] - face.centre);
    require(outward >= -eps_ * size * longest * rho_, face.line,
            "the face is inside out, expected its vertices counter-clockwise from outside and its centre on "
            "the inner side");
    for (Size k = 0; k < 3; ++k) checkSideNormal(f, k);
  }

  void checkSideNormal(Size f, Size k) const {
    const Face& face = file_.faces[f];
    const Vector3d& a = face.corner[k];
    const Vector3d& b = face.corner[(k + 1) % 3];
    checkUnit(face.line, face.side[k].axis);
    const Vector3d normal = (a - face.centre).cross(b - face.centre);
    // Near the smallest R a side may pass close to the centre. Then it hardly determines the plane through
    // both.
    const double length = (b - a).norm(), beside = normal.norm() / length;
    require((face.side[k].axis - normal.normalized()).norm() <=
                turnError((a.norm() + b.norm() + face.centre.norm()) * std::max(1.0, rho_ / beside), length),
            face.line,
            "the normal of side " + std::to_string(k + 1) +
                " of the face is not that of the plane through the side and the centre");
  }

  void checkTorus(const Torus& torus) const {
    const int i = torus.cone[0].id, j = torus.cone[1].id;
    require(i < vertexCount() && j < vertexCount() && i != j, torus.line,
            "the torus names vertices " + std::to_string(i) + " and " + std::to_string(j) +
                ", expected two different ids below " + std::to_string(vertexCount()));
    for (const Border& plane : torus.plane) {
      require(isFace(plane.id), torus.line,
              "the torus names face " + std::to_string(plane.id) + ", expected an id from " +
                  std::to_string(file_.firstFace()) + " to " + std::to_string(file_.firstTorus() - 1));
    }
    checkSphere(torus.line, "torus's rolling", torus.tube, file_.R);
    const Vector3d along = vertex(i) - vertex(j);
    const double length = along.norm(), fromOrigin = vertex(i).norm() + vertex(j).norm();
    const double half = length / 2, circle = std::sqrt(std::max(0.0, (rho_ - half) * (rho_ + half)));
    // A change of the length l changes the circle's radius Rc by l / (4 Rc) times as much, which is a lot
    // only near the smallest R.
    const double circleError = eps_ * (file_.R + fromOrigin * length / std::max(circle, eps_ * rho_));
    require(std::abs(torus.circle - circle) <= circleError, torus.line,
            "the torus's circle has radius " + toDecimal(torus.circle) + ", expected " + toDecimal(circle));
    require((torus.middle - 0.5 * (vertex(i) + vertex(j))).norm() <= eps_ * fromOrigin, torus.line,
            "the torus's centre is not the edge's middle");
    checkUnit(torus.line, torus.axis);
    require((torus.axis - along / length).norm() <= turnError(fromOrigin, length), torus.line,
            "the torus's axis is not along the edge");
    for (Size k = 0; k < 2; ++k)
      checkCone(torus.line, torus.cone[k], k == 0 ? along : Vector3d(-along), fromOrigin);
    for (Size k = 0; k < 2; ++k) {
      checkUnit(torus.line, torus.plane[k].axis);
      checkContainment(torus, face(torus.plane[k].id), face(torus.plane[1 - k].id));
    }
  }

  // All vertices lie in all balls iff the vertices across each edge do, because a surface that is convex at
  // every edge is convex.
  void checkContainment(const Torus& torus, const Face& ball, const Face& across) const {
    for (const Vector3d& p : across.corner) {
      require((p - ball.centre).norm() <= rho_ + sphereError(p, ball.centre), torus.line,
              "a vertex of one of the torus's faces is outside the other's ball");
    }
    const double apart = (ball.centre - across.centre).norm();
    require(torus.real ||
                apart <= eps_ * (ball.centre.norm() + file_.R) + centreError(ball) + centreError(across),
            torus.line, "the torus is marked degenerate, but its two face spheres differ");
  }

  // If three points are uncertain by e, a sphere through them is uncertain by about e rho / (the triangle's
  // height).
  double centreError(const Face& face) const {
    const Vector3d side = face.corner[1] - face.corner[0], other = face.corner[2] - face.corner[0];
    const double longest = std::max({side.norm(), other.norm(), (side - other).norm()});
    const double height = side.cross(other).norm() / longest;
    return eps_ * face.corner[0].norm() * rho_ / std::max(height, eps_ * longest);
  }

  void checkCone(int line, const Border& cone, const Vector3d& along, double fromOrigin) const {
    const double length = along.norm(), cosine = length / (2 * rho_);
    checkUnit(line, cone.axis);
    require((cone.axis - along / length).norm() <= turnError(fromOrigin, length), line,
            "the axis of a cone is not along the edge");
    require(std::abs(cone.cosine - cosine) <=
                eps_ * (cosine + (fromOrigin + length * file_.R / rho_) / (2 * rho_)),
            line,
            "the cosine of a cone is " + toDecimal(cone.cosine) +
                ", expected l / (2 rho) = " + toDecimal(cosine));
  }

  // Side k of a face runs from its corner k to the next. The side and the torus or face that it names must
  // refer to each other.
  void checkSides(Size f) const {
    const Face& face = file_.faces[f];
    const int id = file_.firstFace() + static_cast<int>(f);
    for (Size k = 0; k < 3; ++k) {
      const int a = corners_[f][k], b = corners_[f][(k + 1) % 3], next = face.side[k].id;
      const std::string side = "side " + std::to_string(k + 1) + " of the face names " + std::to_string(next);
      if (isTorus(next)) {
        const Torus& torus = this->torus(next);
        const bool first = torus.cone[0].id == a && torus.cone[1].id == b && torus.plane[0].id == id;
        const bool second = torus.cone[0].id == b && torus.cone[1].id == a && torus.plane[1].id == id;
        require(first || second, face.line,
                side + ", a torus that does not name this face and these vertices");
        const Vector3d& normal = torus.plane[first ? 0 : 1].axis;
        require((normal - face.side[k].axis).norm() <= eps_, torus.line,
                "the torus's plane is not that of its face's side");
      } else {
        require(isFace(next), face.line, side + ", which is neither a face nor a torus");
        const Face& neighbour = this->face(next);
        const Triangle& other = corners_[static_cast<Size>(next - file_.firstFace())];
        bool back = false;
        for (Size m = 0; m < 3; ++m)
          back = back || (other[m] == b && other[(m + 1) % 3] == a && neighbour.side[m].id == id);
        require(back, face.line, side + ", a face that does not name this one");
      }
    }
  }

  // Every side names a torus or a face that names the side back. So if the counts fit, every torus is named
  // twice.
  void checkCount() const {
    std::size_t degenerate = 0;
    for (const Face& face : file_.faces)
      for (const Border& side : face.side) degenerate += isFace(side.id);
    require(degenerate == 2 * (file_.tori.size() - real_.size()), file_.faces.front().line,
            std::to_string(degenerate) +
                " sides of faces name another face, expected two for each torus marked degenerate, " +
                std::to_string(2 * (file_.tori.size() - real_.size())));
  }

  void checkCones(int v) const {
    const Vertex& sphere = file_.vertices[static_cast<Size>(v)];
    std::vector<int> named;
    for (const Border& cone : sphere.tori) {
      require(isTorus(cone.id), sphere.line,
              "the vertex names " + std::to_string(cone.id) + ", which is no torus");
      const Torus& torus = this->torus(cone.id);
      const int i = torus.cone[0].id, j = torus.cone[1].id;
      require(i == v || j == v, sphere.line,
              "the vertex names torus " + std::to_string(cone.id) + ", which does not name it");
      const int other = i == v ? j : i;
      checkCone(sphere.line, cone, vertex(v) - vertex(other), vertex(v).norm() + vertex(other).norm());
      named.push_back(cone.id);
    }
    std::sort(named.begin(), named.end());
    const bool twice = std::adjacent_find(named.begin(), named.end()) != named.end();
    const int tori = toriAt_[static_cast<Size>(v)];
    require(!twice && static_cast<int>(named.size()) == tori, sphere.line,
            "the vertex does not name each of its " + std::to_string(tori) + " tori once");
  }

  const File& file_;
  double eps_, rho_;
  std::vector<const Torus*> real_;
  std::vector<Triangle> corners_;
  std::vector<int> toriAt_;  // number of real tori that name each vertex
};

}  // namespace

std::vector<std::array<int, 3>> check(const File& file) { return Checker(file).run(); }

}  // namespace fcl_stpbv::detail::sch
