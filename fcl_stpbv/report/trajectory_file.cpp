// Reads a trajectory from CSV or JSON: both become named columns of numbers, which are then checked.
#include "fcl_stpbv/report/trajectory_file.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/mesh/json_text.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/joint_names.h"
#include "fcl_stpbv/robot/near_name.h"

namespace fcl_stpbv::report {

using namespace detail;

namespace {

constexpr std::size_t kMostText = 256u << 20;
// Limit of a value, as for a posture: larger than any robot's. Beyond it a sine loses digits.
constexpr double kMost = 1e6;
constexpr const char* kJson = "{\"joints\": [names], \"points\": [[values], ...]}";
constexpr const char* kMessage =
    "{\"joint_names\": [names], \"points\": [{\"positions\": [values], \"time_from_start\": ...}, ...]}";

struct Columns {
  std::vector<std::string> names;
  std::ptrdiff_t time =
      -1;  // index of the time among them; its name is "" if the file gives it none; -1 if there are no times
  std::vector<std::vector<double>> rows;
  std::vector<std::string> places;  // place of each row in the file, for messages
};

// Without blanks and line ends at both ends.
std::string_view trimmed(std::string_view text) {
  const auto isBlank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
  return text;
}

// The quote that ends what begins with the quote at `begin`; the text's size or more if there is none. Two
// quotes stand for one (RFC 4180).
std::size_t closingQuote(std::string_view text, std::size_t begin) {
  std::size_t i = begin + 1;
  for (; i < text.size() && (text[i] != '"' || text.substr(i + 1, 1) == "\""); ++i)
    if (text[i] == '"') ++i;
  return i;
}

// Removes the first cell of a line and the comma after it; `more` tells whether there was one. In quotes a
// comma belongs to the cell.
std::string nextCell(std::string_view& line, bool& more) {
  line = trimmed(line);
  const std::size_t end = line.substr(0, 1) == "\"" ? closingQuote(line, 0) : line.size();
  const bool quoted = end < line.size();
  const std::size_t comma = line.find(',', quoted ? end : 0);
  const std::string_view cell = trimmed(line.substr(0, comma));
  more = comma != std::string_view::npos;
  line.remove_prefix(more ? comma + 1 : line.size());
  if (!quoted || cell.size() != end + 1) return std::string(cell);
  std::string inQuotes(cell.substr(1, end - 1));
  for (std::size_t i = inQuotes.find('"'); i != std::string::npos; i = inQuotes.find('"', i + 1))
    inQuotes.erase(i, 1);
  return inQuotes;
}

std::vector<std::string> cellsOf(std::string_view line) {
  std::vector<std::string> cells;
  for (bool more = true; more;) cells.push_back(nextCell(line, more));
  return cells;
}

// The end of the line of names. A name in quotes may contain line feeds; a quote that never ends is none.
std::size_t endOfNames(std::string_view text) {
  bool begins = true;  // a cell
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n') return i;
    if (begins && text[i] == '"') {
      i = closingQuote(text, i);
      if (i >= text.size()) return std::min(text.find('\n'), text.size());
    }
    begins = text[i] == ',' || (begins && (text[i] == ' ' || text[i] == '\t'));
  }
  return text.size();
}

Columns fromCsv(const std::string& text, const std::string& path) {
  Columns columns;
  if (text.find('\n') == std::string::npos && text.find('\r') != std::string::npos)
    throw Error(path + ": its lines end in carriage returns alone; save it with line feeds");
  std::size_t number = 1, next = 1;  // of this line and the next
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t end = columns.names.empty() ? endOfNames(rest) : std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    number = next;
    next += 1 + static_cast<std::size_t>(std::count(line.begin(), line.end(), '\n'));
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    const std::string place = path + ":" + std::to_string(number);
    const std::vector<std::string> cells = cellsOf(line);
    if (columns.names.empty()) {
      double value = 0;
      if (std::all_of(cells.begin(), cells.end(), [&](const auto& cell) { return readDecimal(cell, value); }))
        throw Error(place + ": got numbers; the first line must name joints");
      columns.names = cells;
      const auto time = std::find(cells.begin(), cells.end(), "time");
      if (time != cells.end()) columns.time = time - cells.begin();
      continue;
    }
    if (cells.size() != columns.names.size())
      throw Error(place + ": has " + std::to_string(cells.size()) + " values, the first line names " +
                  std::to_string(columns.names.size()));
    std::vector<double> row;
    for (const std::string& cell : cells) {
      double value = 0;
      if (!readDecimal(cell, value))
        throw Error(place + ": got " + detail::quoted(cell) + ", expected a number" +
                    (cell.find_first_of("; \t") == std::string::npos ? "" : "; commas stand between values"));
      row.push_back(value);
    }
    columns.rows.push_back(std::move(row));
    columns.places.push_back(place);
  }
  return columns;
}

void refuseOthers(const nlohmann::json& json, const std::set<std::string>& keys, const std::string& where) {
  if (!json.is_object()) throw Error(where + ": is no object of JSON");
  std::string list;
  for (const std::string& key : keys) list += (list.empty() ? "\"" : ", \"") + key + "\"";
  for (const auto& [key, value] : json.items())
    if (keys.count(key) == 0) throw Error(where + ": \"" + key + "\" is none of " + list);
}

void addTimes(const std::vector<double>& times, Columns& columns) {
  columns.time = static_cast<std::ptrdiff_t>(columns.names.size());
  columns.names.emplace_back();
  for (std::size_t i = 0; i < times.size(); ++i) columns.rows[i].push_back(times[i]);
}

void requireValues(const Columns& columns, std::size_t i, const char* key) {
  if (columns.rows[i].size() != columns.names.size())
    throw Error(columns.places[i] + " has " + std::to_string(columns.rows[i].size()) + " values, \"" + key +
                "\" names " + std::to_string(columns.names.size()));
}

// A duration of ROS: a number, or seconds and nanoseconds under ROS 1's names or ROS 2's.
double secondsOf(const nlohmann::json& duration, const std::string& where) {
  if (duration.is_number()) return duration.get<double>();
  if (!duration.is_object()) throw Error(where + ": expected seconds, or \"sec\" and \"nanosec\"");
  const bool old = duration.contains("secs") || duration.contains("nsecs");
  const char* const seconds = old ? "secs" : "sec";
  const char* const rest = old ? "nsecs" : "nanosec";
  refuseOthers(duration, {seconds, rest}, where);
  return duration.value(seconds, 0.0) + 1e-9 * duration.value(rest, 0.0);
}

// A trajectory_msgs/JointTrajectory. Planners that give no times leave all of them at 0.
Columns fromMessage(const nlohmann::json& json, const std::string& path) {
  Columns columns;
  refuseOthers(json, {"header", "joint_names", "points"}, path);
  columns.names = json.at("joint_names").get<std::vector<std::string>>();
  std::vector<double> times;
  if (!json.at("points").is_array()) throw Error(path + ": \"points\" is no list");
  for (const nlohmann::json& point : json.at("points")) {
    const std::size_t i = columns.rows.size();
    columns.places.push_back(path + ": points[" + std::to_string(i) + "]");
    refuseOthers(point, {"positions", "velocities", "accelerations", "effort", "time_from_start"},
                 columns.places[i]);
    columns.rows.push_back(point.at("positions").get<std::vector<double>>());
    requireValues(columns, i, "joint_names");
    if (point.contains("time_from_start"))
      times.push_back(secondsOf(point["time_from_start"], columns.places[i] + ".time_from_start"));
  }
  if (!times.empty() && times.size() != columns.rows.size())
    throw Error(path + ": " + std::to_string(times.size()) + " of " + std::to_string(columns.rows.size()) +
                " points have a \"time_from_start\"; give all of them one, or none");
  if (std::any_of(times.begin(), times.end(), [](double time) { return time != 0; }))
    addTimes(times, columns);
  return columns;
}

Columns fromJson(const std::string& text, const std::string& path) {
  const nlohmann::json json = parseJson(text, path);
  if (!json.is_object()) throw Error(path + ": is no object of JSON, expected " + kJson);
  const bool message = json.contains("joint_names");
  Columns columns;
  try {
    if (message) return fromMessage(json, path);
    refuseOthers(json, {"joints", "points", "time"}, path);
    columns.names = json.at("joints").get<std::vector<std::string>>();
    columns.rows = json.at("points").get<std::vector<std::vector<double>>>();
    for (std::size_t i = 0; i < columns.rows.size(); ++i) {
      columns.places.push_back(path + ": points[" + std::to_string(i) + "]");
      requireValues(columns, i, "joints");
    }
    if (json.contains("time")) {
      const auto time = json.at("time").get<std::vector<double>>();
      if (time.size() != columns.rows.size())
        throw Error(path + ": \"time\" has " + std::to_string(time.size()) + " values, \"points\" has " +
                    std::to_string(columns.rows.size()));
      addTimes(time, columns);
    }
  } catch (const nlohmann::json::exception& error) {
    throw Error(path + ": expected " + (message ? kMessage : kJson) + " (" + error.what() + ")");
  }
  return columns;
}

// Says why a name is not the name of a coordinate.
std::string whyNone(const std::string& name, const Kinematics& kinematics) {
  const std::vector<JointModel>& joints = kinematics.robot().joints;
  const auto joint =
      std::find_if(joints.begin(), joints.end(), [&](const JointModel& j) { return j.name == name; });
  const std::vector<std::string>& names = kinematics.names();
  if (joint == joints.end() || joint->type == JointType::fixed) {
    std::vector<std::string> known = valueNames(kinematics);
    if (name != "time") known.emplace_back("time");
    const std::string near = didYouMean(name, known);
    return "the robot has no moving joint '" + name + "'" +
           (!near.empty()   ? near
            : names.empty() ? ""
                            : "; its joints are " + names.front() + " ... " + names.back());
  }
  if (joint->mimic)
    return "'" + name + "' follows '" + joints[at(joint->mimic->joint)].name + "'; leave its column out";
  return "'" + name + "' has several coordinates; name " + names[at(kinematics.coordinate(name))] +
         " and the others";
}

// The coordinate of each column, -1 for the time.
std::vector<int> coordinatesOf(const Columns& columns, const std::string& path,
                               const Kinematics& kinematics) {
  std::vector<int> coordinates;
  std::set<std::string> seen;
  for (const std::string& name : columns.names) {
    const bool isTime = static_cast<std::ptrdiff_t>(coordinates.size()) == columns.time;
    const auto& names = kinematics.names();
    const auto found = std::find(names.begin(), names.end(), name);
    if (isTime && found != names.end())
      throw Error(
          path +
          ": 'time' is a joint of the robot, and the time of way points; give JSON, which has a place "
          "of its own for the times, or rename the joint");
    if (!seen.insert(name).second) throw Error(path + ": names '" + name + "' twice");
    if (!isTime && found == names.end()) throw Error(path + ": " + whyNone(name, kinematics));
    coordinates.push_back(isTime ? -1 : static_cast<int>(found - names.begin()));
  }
  if (static_cast<int>(coordinates.size()) == (columns.time >= 0 ? 1 : 0))
    throw Error(path + ": names no joint");
  return coordinates;
}

}  // namespace

Trajectory readTrajectory(const std::string& path, const Kinematics& kinematics,
                          const Eigen::VectorXd& rest) {
  std::string text = readText(path, kMostText);
  if (text.compare(0, 3, "\xef\xbb\xbf") == 0) text.erase(0, 3);  // a byte order mark
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos)
    throw Error(path + ": is empty; expected a line of joint names and way points");
  const Columns columns =
      text[first] == '{' || text[first] == '[' ? fromJson(text, path) : fromCsv(text, path);
  const std::vector<int> coordinates = coordinatesOf(columns, path, kinematics);
  if (columns.rows.size() < 2)
    throw Error(path + ": has " + std::to_string(columns.rows.size()) + " way points, a motion needs two");
  Trajectory trajectory;
  trajectory.timed = std::count(coordinates.begin(), coordinates.end(), -1) > 0;
  for (std::size_t i = 0; i < columns.rows.size(); ++i) {
    Eigen::VectorXd q = rest;
    double time = static_cast<double>(i);
    for (std::size_t k = 0; k < coordinates.size(); ++k) {
      const double value = columns.rows[i][k];
      const bool isTime = coordinates[k] < 0;
      if (!isTime && !(std::abs(value) <= kMost))
        throw Error(columns.places[i] + ": " + columns.names[k] + " must be from -1e6 to 1e6");
      (isTime ? time : q[coordinates[k]]) = value;
    }
    if (i == 0 && std::abs(time) > kMost) trajectory.start = time;
    time -= trajectory.start;
    const double begin = i == 0 ? time : trajectory.time.front();
    if (trajectory.timed && !(std::abs(time - begin) <= kMost))
      throw Error(columns.places[i] + ": the time must be a number within 1e6 s of the first way point's");
    constexpr double kLeastStep = 1e-9;  // s; no robot gets anywhere in less
    if (i > 0 && !(time - trajectory.time.back() >= kLeastStep))
      throw Error(columns.places[i] +
                  ": the time must grow from one way point to the next, by 1e-9 s or more");
    trajectory.points.push_back(std::move(q));
    trajectory.time.push_back(time);
  }
  return trajectory;
}

}  // namespace fcl_stpbv::report
