// Reads the fields of sch-core's text format token by token into sch_data.h; checks ranges, not geometry.
#include <algorithm>
#include <cmath>
#include <limits>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/sch_data.h"
#include "fcl_stpbv/io/text_scanner.h"

namespace fcl_stpbv::detail::sch {
namespace {

// Least number of bytes of each item: each of its tokens takes a character and a blank.
constexpr std::size_t kVertexBytes = 2 * 5;
constexpr std::size_t kBorderBytes = 2 * 5;
constexpr std::size_t kFaceBytes = 2 * 25;
constexpr std::size_t kTorusBytes = 2 * 27;

int readId(TextScanner& in, const char* what) {
  return static_cast<int>(in.integer(what, 0, std::numeric_limits<int>::max()));
}

// Member by member, because the fields must be read in the order of the file.
Border readCone(TextScanner& in, const char* what) {
  Border cone;
  cone.id = readId(in, what);
  cone.cosine = in.number("the cosine of a cone");
  cone.axis = in.vector("the axis of a cone");
  return cone;
}

Border readPlane(TextScanner& in, const char* what) {
  Border plane;
  plane.id = readId(in, what);
  plane.cosine = 0;
  plane.axis = in.vector("the normal of a plane");
  return plane;
}

Vertex readVertex(TextScanner& in) {
  Vertex vertex;
  vertex.radius = in.number("the radius of a vertex sphere");
  vertex.line = in.line();
  vertex.centre = in.vector("a vertex coordinate");
  vertex.tori.resize(static_cast<std::size_t>(in.count("number of a vertex's tori", 0, kBorderBytes)));
  for (Border& torus : vertex.tori) torus = readCone(in, "the id of a vertex's torus");
  return vertex;
}

Face readFace(TextScanner& in) {
  Face face;
  face.radius = in.number("the radius of a face sphere");
  face.line = in.line();
  face.centre = in.vector("a coordinate of a face sphere's centre");
  for (Eigen::Vector3d& corner : face.corner) corner = in.vector("a coordinate of a face's vertex");
  for (Border& side : face.side) side = readPlane(in, "the id of a face's neighbour");
  return face;
}

Torus readTorus(TextScanner& in) {
  Torus torus;
  torus.real = in.integer("a torus's flag", 0, 1) == 1;
  torus.line = in.line();
  torus.circle = in.number("the radius of a torus's circle");
  torus.tube = in.number("the radius of a torus's tube");
  torus.middle = in.vector("a coordinate of a torus's centre");
  torus.axis = in.vector("the axis of a torus");
  for (Border& cone : torus.cone) cone = readCone(in, "the id of a torus's vertex");
  for (Border& plane : torus.plane) plane = readPlane(in, "the id of a torus's face");
  return torus;
}

}  // namespace

double File::rounding() const {
  // A number printed with d digits is off by half a unit in its last place. That is 0.5e(1-d) of the number
  // if it begins with a 1. No number is expected to be more exact than a few roundings of a double.
  constexpr double kFewRoundings = 16 * std::numeric_limits<double>::epsilon();
  return std::max(0.5 * std::pow(10.0, 1 - digits), kFewRoundings);
}

void File::fail(int line, const std::string& message) const {
  throw Error(name + ":" + std::to_string(line) + ": " + message);
}

File parse(std::string_view text, const std::string& name) {
  TextScanner in(text, name);
  File file;
  file.name = name;
  file.r = in.number("the small radius r");
  file.R = in.number("the big radius R");
  if (file.r < 0 || file.R <= file.r) in.fail("invalid radii r and R, expected 0 <= r < R");
  file.vertices.resize(static_cast<std::size_t>(in.count("number of vertices", 1, kVertexBytes)));
  for (Vertex& vertex : file.vertices) vertex = readVertex(in);
  file.faces.resize(static_cast<std::size_t>(in.count("number of faces", 0, kFaceBytes)));
  for (Face& face : file.faces) face = readFace(in);
  file.tori.resize(static_cast<std::size_t>(in.count("number of tori", 0, kTorusBytes)));
  for (Torus& torus : file.tori) torus = readTorus(in);
  in.end();
  file.digits = in.digits();
  return file;
}

}  // namespace fcl_stpbv::detail::sch
