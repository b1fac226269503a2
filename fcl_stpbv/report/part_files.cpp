// Makes a mesh and a volume for each part, named after its link; then the manifest with their bounds, the
// URDF and the SRDF.
#include "fcl_stpbv/report/part_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <sstream>

#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/io/volume_files.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/parts/mesh_solid.h"
#include "fcl_stpbv/report/digest.h"
#include "fcl_stpbv/report/kept_folder.h"
#include "fcl_stpbv/report/report_formats.h"
#include "fcl_stpbv/robot/keyed_mesh.h"

namespace fcl_stpbv::report {

using namespace detail;
using nlohmann::ordered_json;

namespace {

namespace fs = std::filesystem;

// The hull of a part as an OBJ file; the coordinates are written so that they read back exactly.
std::string objOf(const std::vector<Eigen::Vector3d>& points) {
  std::string text = "# A convex part, by urdf_to_stpbv. Metres.\n";
  std::map<std::array<double, 3>, int> number;
  for (const Eigen::Vector3d& p : points) {
    const int next = static_cast<int>(number.size()) + 1;
    if (!number.emplace(std::array<double, 3>{p.x(), p.y(), p.z()}, next).second) continue;
    text += "v ";
    appendVector(text, p);
    text += '\n';
  }
  for (const Triangle& triangle : hullTriangles(points)) {
    text += 'f';
    for (const Eigen::Vector3d& p : triangle) text += " " + std::to_string(number.at({p.x(), p.y(), p.z()}));
    text += '\n';
  }
  return text;
}

std::string stpbvOf(const StpBv& volume) {
  std::ostringstream out;
  saveStpBv(out, volume);
  return out.str();
}

}  // namespace

PartFiles::PartFiles(const RobotConversion& conversion, const CollisionReport& report)
    : conversion_(conversion),
      report_(report),
      hulls_(report.geometry, conversion.report.files.geometry.cacheFolder) {}

// The body's name with letters, digits, '_' and '-' only, made different from all file names in use.
std::string PartFiles::fileName(const std::string& body) {
  std::string name;
  for (const char c : body)
    name += std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' ? c : '_';
  while (!taken_.insert(name).second) name += '_';
  return name;
}

FolderFiles PartFiles::make(const ordered_json& inputs, const std::string& key) {
  const RobotModel& robot = *report_.robot;
  const auto collision = [](const LinkModel& link) { return !link.collision.empty(); };
  PartUrdf urdf{&robot, false, {}, conversion_.folder};
  urdf.visual = conversion_.report.files.geometry.visual ||
                std::none_of(robot.links.begin(), robot.links.end(), collision);
  certifyHulls();
  for (const LinkModel& link : robot.links) {
    const std::vector<ShapeModel>& shapes = urdf.visual ? link.visual : link.collision;
    for (std::size_t s = 0; s < shapes.size(); ++s) add(link, shapes[s], s, urdf);
  }
  const std::string stem = fs::path(robot.path).stem().string();
  files_[stem + ".urdf"] = urdfWithParts(urdf);
  files_[stem + ".srdf"] = toSrdfText(report_, conversion_.disableDefault);
  files_[kManifest] = manifest(inputs, key, stem);
  return std::move(files_);
}

// A body that is not split is convex or stays whole. It is one part, with a bound as good as those of other
// parts.
void PartFiles::certifyHulls() {
  const GeometryOptions& options = conversion_.report.files.geometry;
  std::map<int, int> one;
  for (const Body& body : report_.geometry->bodies)
    if (body.partOf < 0 && body.parts == 0 && !body.file.empty()) one[body.link] = 1;
  hulls_.prepare(one, options.threads, options.progress);
}

const Body* PartFiles::bodyOf(const LinkModel& link, std::size_t shape) const {
  const std::string name = shape == 0 ? link.name : link.name + "#" + std::to_string(shape + 1);
  const std::vector<Body>& bodies = report_.geometry->bodies;
  const auto found = std::find_if(bodies.begin(), bodies.end(), [&](const Body& body) {
    return body.partOf < 0 && body.name == name && report_.robot->links[at(body.link)].name == link.name;
  });
  return found == bodies.end() ? nullptr : &*found;
}

// The parts that stand for a mesh. None for points without triangles, which are their own hull.
std::vector<const Body*> PartFiles::partsOf(int index) {
  std::vector<const Body*> parts;
  for (const Body& part : report_.geometry->bodies)
    if (part.partOf == index) parts.push_back(&part);
  if (parts.empty())
    for (const Body& part : hulls_.of(index, 1)) parts.push_back(&part);
  return parts;
}

void PartFiles::add(const LinkModel& link, const ShapeModel& shape, std::size_t number, PartUrdf& urdf) {
  const Body* body = bodyOf(link, number);
  if (!body) return;  // the shape was wrong and left out
  ordered_json entry{{"link", link.name}, {"body", body->name}};
  if (body->file.empty()) {
    entry["mesh"] = nullptr;
    addVolume(*body, fileName(body->name), entry);
  } else {
    addMesh(*body, entry, urdf.meshes[shape.place]);
  }
  links_.push_back(std::move(entry));
}

void PartFiles::addVolume(const Body& body, const std::string& name, ordered_json& entry) {
  if (!body.volume) return;
  const std::string file = "volumes/" + name + ".stpbv";
  files_[file] = stpbvOf(*body.volume);
  entry["volume"] = file;
  entry["r"] = body.volume->radii().r;
  entry["R"] = body.volume->radii().R;
  entry["vertices"] = body.volume->vertexCount();
  entry["over_cover_max"] = body.cover.max;
  entry["over_cover_mean"] = body.cover.mean;
}

void PartFiles::addMesh(const Body& body, ordered_json& entry, std::vector<std::string>& meshes) {
  const KeyedMesh source(body);
  entry["mesh"] = body.file;
  entry["mesh_sha256"] = sha256(source.text());
  entry["scale"] = {body.scale.x(), body.scale.y(), body.scale.z()};
  const std::vector<const Body*> parts = partsOf(static_cast<int>(&body - report_.geometry->bodies.data()));
  double hull = 0, open = 0, cover = 0;
  for (std::size_t k = 0; k < std::max<std::size_t>(1, parts.size()); ++k) {
    const std::string file = fileName(parts.size() > 1 ? body.name + "_" + std::to_string(k) : body.name);
    const std::string mesh = "meshes/" + file + ".obj";
    files_[mesh] = objOf(parts.empty() ? source.mesh().vertices : parts[k]->hull);
    meshes.push_back(conversion_.meshPrefix + mesh);
    const Body& smooth = parts.size() > 1 ? *parts[k] : body;
    ordered_json part{{"collision", mesh}};
    if (!parts.empty()) {
      part["hull_excess_max"] = parts[k]->excess;
      part["hull_excess_max_open"] = parts[k]->openExcess;
      hull = std::max(hull, parts[k]->excess);
      open = std::max(open, parts[k]->openExcess);
    }
    addVolume(smooth, file, part);
    cover = std::max(cover, smooth.volume ? smooth.cover.max : 0.0);
    entry["parts"].push_back(std::move(part));
    ++parts_;
  }
  entry["hull_excess_max"] = hull;
  entry["excess_max"] = hull + cover;
  entry["excess_max_open"] = open + cover;
  excess_ = std::max(excess_, hull + cover);
}

std::string PartFiles::manifest(const ordered_json& inputs, const std::string& key, const std::string& stem) {
  ordered_json json{{"program", "urdf_to_stpbv"},
                    {"robot", report_.robot->name},
                    {"urdf", stem + ".urdf"},
                    {"srdf", stem + ".srdf"},
                    {"inputs", inputs},
                    {"excess_max", excess_},
                    {"links", links_},
                    {"left_out", report_.skipped},
                    {"warnings", report_.warnings}};
  std::map<std::string, int> reasons;
  for (const PairReport& pair : report_.pairs) ++reasons[pair.reason];
  json["pairs"] = {{"total", report_.pairs.size()}, {"checked", report_.checked}, {"reasons", reasons}};
  addFiles(json, key, files_);
  return json.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace fcl_stpbv::report
