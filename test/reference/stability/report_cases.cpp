// Published reports: one situation for each file of data/hard_cases. Also pairs that were found in this
// project.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "test/reference/hard_cases.h"
#include "test/reference/stability/situation.h"

namespace fcl_stpbv::stability {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

struct Half {
  Cloud points;
  std::vector<int> facets;
};

[[noreturn]] void fail(const std::filesystem::path& file, int line, const std::string& what) {
  throw std::runtime_error(file.string() + ":" + std::to_string(line) + ": " + what);
}

/// Printed matrices are rotations only to some digits. The rotation that is meant is uncertain by as much
/// (m).
double openByRotation(const Situation& s) {
  double open = 0;
  for (const Placement& at : s.placements) {
    const auto defect = [](const Isometry3d& p) {
      return (p.linear().transpose() * p.linear() - Eigen::Matrix3d::Identity()).norm();
    };
    open = std::max(open, 2 * (defect(at.a) + defect(at.b)) * sizeOf(s, at));
  }
  return open < 1e-15 ? 0 : open;
}

/// Loads a case. Its format is in data/hard_cases/README.md.
Situation load(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot open " + path.string());
  Situation s;
  s.group = "published reports";
  StpBvOptions radii;
  Half halves[2];
  int body = -1, number = 0;
  Placement at{Isometry3d::Identity(), Isometry3d::Identity()};
  for (std::string line; std::getline(file, line);) {
    ++number;
    std::istringstream words(line);
    std::string word;
    if (!(words >> word) || word[0] == '#') continue;
    const auto rest = [&] {
      std::string text;
      std::getline(words >> std::ws, text);
      return text;
    };
    if (word == "report") {
      s.name = rest();
    } else if (word == "said") {
      s.source += (s.source.empty() ? "" : " ") + rest();
    } else if (word == "radii") {
      words >> radii.r >> radii.R;
    } else if (word == "body") {
      if (++body > 1) fail(path, number, "a third body");
    } else if (word == "v" && body >= 0) {
      Vector3d p;
      words >> p[0] >> p[1] >> p[2];
      halves[body].points.push_back(p);
    } else if (word == "f" && body >= 0) {
      std::vector<int> facet;
      for (int i; words >> i;) facet.push_back(i);
      words.clear();
      halves[body].facets.push_back(static_cast<int>(facet.size()));
      halves[body].facets.insert(halves[body].facets.end(), facet.begin(), facet.end());
    } else if (word == "pose" && body >= 0) {
      Eigen::Matrix<double, 3, 4> m;
      for (int i = 0; i < 12; ++i) words >> m(i / 4, i % 4);
      (body == 0 ? at.a : at.b) = test::pose(m.leftCols<3>(), m.col(3));
    } else if (word == "next") {  // another placement of the same bodies
      s.placements.push_back(at);
      body = -1;
    } else {
      fail(path, number, "unknown word '" + word + "'");
    }
    if (words.fail()) fail(path, number, "a number is missing");
  }
  s.placements.push_back(at);
  if (s.name.empty() || s.source.empty()) fail(path, number, "no report or no said line");
  s.a = makeBody(halves[0].points, radii, halves[0].facets);
  s.b = makeBody(halves[1].points, radii, halves[1].facets);
  s.slack = openByRotation(s);
  return s;
}

Situation fromTest(const test::HardCase& c, const char* group, const char* said) {
  Situation s;
  s.group = group;
  s.name = c.name;
  s.source = said;
  s.a = makeBody(c.first);
  s.b = makeBody(c.second);
  s.placements.push_back({c.pose1, c.pose2});
  s.slack = openByRotation(s);
  return s;
}

}  // namespace

void addReports(std::vector<Situation>& all, const std::string& folder) {
  if (!std::filesystem::is_directory(folder)) throw std::runtime_error("no folder " + folder);
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".case") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const std::filesystem::path& file : files) all.push_back(load(file));
  for (const test::HardCase& c : test::fieldCases(folder + "/fcl_field_cases.txt"))
    all.push_back(fromTest(c, "published reports", "the signed query throws"));
  for (const test::HardCase& c : test::equalNormCases())
    all.push_back(fromTest(c, "equal norms", "FCL's distance stops where two norms agree"));
}

}  // namespace fcl_stpbv::stability
