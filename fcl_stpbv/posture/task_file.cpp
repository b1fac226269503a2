// Reads the JSON of a task (docs/posture.md) field by field. An unknown key or a wrong type is an Error that
// names the path of the field.
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/mesh/json_text.h"
#include "fcl_stpbv/posture/task.h"
#include "fcl_stpbv/robot/near_name.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using nlohmann::json;

constexpr int kMostParts = 64;  // parts of a link; more would make too many rows

// A value and the path to it, for messages such as "task.json: placements[1].link: ...".
class Field {
 public:
  Field(const json& value, std::string where) : value_(value), where_(std::move(where)) {}

  [[noreturn]] void refuse(const std::string& expected) const {
    throw Error(where_ + ": expected " + expected);
  }

  // Requires an object with these keys and no others.
  const Field& object(const std::set<std::string>& keys) const {
    std::string list;
    for (const std::string& key : keys) list += (list.empty() ? "" : ", ") + key;
    if (!value_.is_object()) refuse("an object with the keys " + list);
    for (const auto& [key, unused] : value_.items()) {
      (void)unused;
      if (!keys.count(key))
        throw Error(where_ + ": unknown key '" + key + "'; known are " + list +
                    didYouMean(key, {keys.begin(), keys.end()}));
    }
    return *this;
  }

  bool has(const char* key) const { return value_.contains(key); }
  Field operator[](const char* key) const {
    if (!has(key)) throw Error(where_ + ": the key '" + key + "' is missing");
    return Field(value_.at(key), (top_ ? where_ + ": " : where_ + ".") + key);
  }
  std::vector<Field> list(const std::string& of) const {
    if (!value_.is_array()) refuse("a list of " + of);
    std::vector<Field> fields;
    for (std::size_t i = 0; i < value_.size(); ++i)
      fields.emplace_back(value_[i], where_ + "[" + std::to_string(i) + "]");
    return fields;
  }

  double number(double least = -1e6, double most = 1e6) const {
    if (!value_.is_number()) refuse("a number");
    const double number = value_.get<double>();
    if (!(number >= least && number <= most))
      refuse("a number from " + toDecimal(least) + " to " + toDecimal(most));
    return number;
  }
  // Whether the value is the word auto. The word none gives false.
  bool autoOrNone(const std::string& orElse) const {
    if (value_ != "auto" && value_ != "none") refuse("auto, none or " + orElse);
    return value_ == "auto";
  }
  bool isWhole(int least, int most) const {
    return value_.is_number_integer() && value_ >= least && value_ <= most;
  }
  bool boolean() const {
    if (!value_.is_boolean()) refuse("true or false");
    return value_.get<bool>();
  }
  std::string text() const {
    if (!value_.is_string()) refuse("a text");
    return value_.get<std::string>();
  }
  std::string oneOf(const std::vector<std::string>& words) const {
    std::string list;
    for (const std::string& word : words) {
      if (value_ == word) return word;
      list += (list.empty() ? "" : ", ") + word;
    }
    refuse("one of " + list);
  }
  std::vector<std::string> texts() const {
    std::vector<std::string> all;
    for (const Field& field : list("names")) all.push_back(field.text());
    return all;
  }
  Eigen::Vector3d vector() const {
    const std::vector<Field> fields = list("three numbers");
    if (fields.size() != 3) refuse("three numbers");
    return {fields[0].number(), fields[1].number(), fields[2].number()};
  }
  std::map<std::string, double> numbers(double least = -1e6) const {
    if (!value_.is_object()) refuse("an object of joints and numbers");
    std::map<std::string, double> all;
    for (const auto& [key, value] : value_.items()) all[key] = Field(value, where_ + "." + key).number(least);
    return all;
  }
  // Position and roll, pitch, yaw as in a URDF; either may be missing.
  Eigen::Isometry3d pose() const {
    object({"position", "rpy"});
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    if (has("position")) pose.translation() = (*this)["position"].vector();
    if (has("rpy")) {
      const Eigen::Vector3d rpy = (*this)["rpy"].vector();
      pose.linear() = (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
                       Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
                       Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
                          .toRotationMatrix();
    }
    return pose;
  }

  static Field top(const json& value, const std::string& path) {
    Field field(value, path);
    field.top_ = true;
    return field;
  }

 private:
  const json& value_;
  std::string where_;
  bool top_ = false;
};

void readStart(const Field& field, PostureTask& task) {
  field.object({"state", "base", "joints"});
  if (field.has("state")) task.state = field["state"].text();
  if (field.has("base")) task.basePose = field["base"].pose();
  if (field.has("joints")) task.joints = field["joints"].numbers();
}

void readCost(const Field& field, PostureTask& task) {
  field.object({"towards", "weights"});
  if (field.has("towards")) task.towardsStart = field["towards"].oneOf({"quarter", "start"}) == "start";
  if (field.has("weights")) task.weights = field["weights"].numbers(0);
}

PostureTask::Place readPlacement(const Field& field) {
  field.object({"name", "link", "frame", "target", "free"});
  PostureTask::Place place;
  place.link = field["link"].text();
  place.placement.name = field.has("name") ? field["name"].text() : place.link;
  if (field.has("frame")) place.placement.frame = field["frame"].pose();
  place.placement.target = field["target"].pose();
  if (!field["target"].has("position") && !field["target"].has("rpy"))
    field["target"].refuse("a position, an rpy or both; {\"position\": [0, 0, 0]} is the origin");
  if (!field.has("free")) return place;
  const std::vector<std::string> directions{"x", "y", "z", "rx", "ry", "rz"};
  for (const Field& word : field["free"].list("directions")) {
    const auto found = std::find(directions.begin(), directions.end(), word.oneOf(directions));
    place.placement.free[static_cast<std::size_t>(found - directions.begin())] = true;
  }
  return place;
}

void readStability(const Field& field, PostureTask& task) {
  field.object({"contacts", "margin"});
  if (field.has("margin")) task.stabilityMargin = field["margin"].number(0);
  for (const Field& contact : field["contacts"].list("contacts")) {
    contact.object({"link", "points"});
    PostureTask::Touch touch{contact["link"].text(), {}};
    for (const Field& point : contact["points"].list("points")) touch.points.push_back(point.vector());
    if (touch.points.empty()) contact["points"].refuse("at least one point");
    task.contacts.push_back(touch);
  }
  if (task.contacts.empty()) field["contacts"].refuse("at least one contact");
}

std::vector<std::string> textsOf(const Field& item, const char* key) {
  return item.has(key) ? item[key].texts() : std::vector<std::string>{};
}

// Two placements with one name would give two violations with one name.
void tellApart(std::vector<PostureTask::Place>& places) {
  std::map<std::string, int> all, seen;
  for (const PostureTask::Place& place : places) ++all[place.placement.name];
  for (PostureTask::Place& place : places) {
    std::string& name = place.placement.name;
    if (all[name] > 1) name += "#" + std::to_string(++seen[name]);
  }
}

// `keys` are links, obstacles and perhaps self.
std::vector<LinkObstacles> readPairs(const Field& field, const std::set<std::string>& keys) {
  std::vector<LinkObstacles> lists;
  for (const Field& item : field.list("objects")) {
    item.object(keys);
    lists.push_back({textsOf(item, "links"), textsOf(item, "obstacles"), {}});
    if (item.has("self")) lists.back().self = item["self"].texts();
    if (keys.count("self") && lists.back().links.empty() && lists.back().obstacles.empty() &&
        !lists.back().self)
      item.refuse("names in links or obstacles, or the key self; without them all pairs with obstacles go");
  }
  return lists;
}

void readCollisions(const Field& field, PostureTask& task) {
  field.object({"margin", "self", "pairs", "ignore", "parts"});
  if (field.has("margin")) task.collisionMargin = field["margin"].number(-1, 1);
  if (field.has("self")) task.selfCollisions = field["self"].boolean();
  if (field.has("pairs")) task.pairs = readPairs(field["pairs"], {"links", "obstacles"});
  if (field.has("ignore")) task.ignore = readPairs(field["ignore"], {"links", "obstacles", "self"});
  if (!field.has("parts")) return;
  const Field parts = field["parts"];
  if (parts.isWhole(2, kMostParts))
    task.parts = static_cast<int>(parts.number());
  else
    task.partsAuto = parts.autoOrNone("a whole number from 2 to " + std::to_string(kMostParts));
}

}  // namespace

PostureTask parseTask(const std::string& text, const std::string& path) {
  const json document = parseJson(text, path);
  const Field root = Field::top(document, path);
  root.object({"base", "start", "cost", "placements", "stability", "collisions"});
  PostureTask task;
  task.path = path;
  task.saysBase = root.has("base");
  if (task.saysBase) {
    const std::string base = root["base"].oneOf({"floating", "planar", "fixed"});
    task.base = base == "floating" ? BaseMotion::floating
                : base == "planar" ? BaseMotion::planar
                                   : BaseMotion::fixed;
  }
  if (root.has("start")) readStart(root["start"], task);
  if (root.has("cost")) readCost(root["cost"], task);
  for (const Field& item : root["placements"].list("placements"))
    task.placements.push_back(readPlacement(item));
  tellApart(task.placements);
  if (document.size() == 1 && task.placements.empty())  // a form that was not filled in
    throw Error(path +
                ": asks for nothing; give a placement, contacts in \"stability\", or a \"start\" with "
                "\"cost\": {\"towards\": \"start\"} to stay near it");
  if (root.has("stability")) readStability(root["stability"], task);
  if (root.has("collisions")) readCollisions(root["collisions"], task);
  return task;
}

PostureTask loadTask(const std::string& path) { return parseTask(readText(path), path); }

}  // namespace fcl_stpbv
