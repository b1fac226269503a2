// The table of a text report's pairs: those that collide by what their collision comes from, then the others.
#include <algorithm>
#include <cmath>

#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/report/pair_cause.h"
#include "fcl_stpbv/report/report_formats.h"
#include "fcl_stpbv/report/text_table.h"

namespace fcl_stpbv::report {
namespace {

using detail::counted;
using detail::signedFixed;

std::string steepest(const PairReport& pair) {
  const auto top =
      std::max_element(pair.gradient.begin(), pair.gradient.end(),
                       [](const auto& a, const auto& b) { return std::abs(a.second) < std::abs(b.second); });
  return top == pair.gradient.end() ? "" : signedFixed(top->second, 3) + " " + top->first;
}

// Of a pair's hulls; they overlap where they have no distance.
std::string hullCell(const PairReport& pair) {
  return std::isfinite(pair.hullDistance) ? millimetres(pair.hullDistance) : "overlap";
}

/// Pairs of the table that have something in common, and how many of it there are in all.
struct Shown {
  std::string heading;
  std::vector<const PairReport*> pairs;
  std::size_t all = 0;
};

// The checked pairs by what their collision comes from, those that do not collide last; within a group as the
// report has them. Cut so that each group has its share of the lines: what only hulls or margins make collide
// does not hide behind contacts.
std::vector<Shown> shownPairs(const CollisionReport& report, std::size_t top) {
  constexpr std::size_t kGroups = 4;
  const char* const causes[kGroups] = {kMeshesMeet, kHullOnly, kMarginOnly, ""};
  std::vector<const PairReport*> groups[kGroups], shown;
  for (const PairReport& pair : report.pairs) {
    if (!pair.checked) continue;
    const bool first = pair.stopsTrajectory && shown.empty();
    const auto group = std::find(causes, causes + kGroups - 1, pair.colliding ? pair.cause : "") - causes;
    (first ? shown : groups[group]).push_back(&pair);
  }
  std::size_t lines = top - std::min(top, shown.size());
  std::size_t counts[kGroups] = {};
  const auto colliding = static_cast<std::size_t>(
      std::count_if(groups, groups + kGroups - 1, [](const auto& group) { return !group.empty(); }));
  const std::size_t share = colliding == 0 ? 0 : std::max<std::size_t>(1, lines / colliding);
  for (std::size_t i = 0; i + 1 < kGroups; ++i)
    lines -= counts[i] = std::min({share, lines, groups[i].size()});
  std::vector<Shown> all;
  if (!shown.empty() && top > 0) {
    const bool touches = report.trajectory->verdict == MotionVerdict::contact;
    all.push_back({touches ? "first contact" : "not decided", shown, shown.size()});
  }
  for (std::size_t i = 0; i < kGroups; ++i) {
    const std::size_t count = counts[i] + std::min(lines, groups[i].size() - counts[i]);
    lines -= count - counts[i];
    if (count == 0) continue;
    const auto begin = groups[i].begin();
    all.push_back({i + 1 < kGroups ? causes[i] : "clear",
                   {begin, begin + static_cast<std::ptrdiff_t>(count)},
                   groups[i].size()});
  }
  return all;
}

// Says where a list of its own begins, as distances start anew there.
std::string headingOf(const Shown& group) {
  const std::size_t shown = group.pairs.size();
  return group.heading +
         (shown < group.all ? ", the " + std::to_string(shown) + " closest of " + counted(group.all, "pair")
                            : ", " + counted(shown, "pair")) +
         ":";
}

}  // namespace

std::string pairsText(const CollisionReport& report, std::size_t top) {
  const std::vector<Shown> shown = shownPairs(report, top);
  const bool byCause = report.colliding > 0;
  const bool timed = report.trajectory.has_value();
  TextTable table(timed ? "lrrrlrl" : "lrrrll");
  const auto add = [&](std::vector<std::string> line, const std::string& time, const std::string& last) {
    if (timed) line.push_back(time);
    line.push_back(last);
    table.add(line);
  };
  add({"", "STP-BV", byCause ? "meshes" : "hulls", "cover", ""}, "closest", "steepest joint");
  add({"pair", "[mm]", "[mm]", "[mm]", byCause ? "cause" : "reason"}, "at", "[m/rad or m/m]");
  bool gaps = false;
  for (const Shown& group : shown) {
    if (shown.size() > 1) table.add({headingOf(group)});
    for (const PairReport* pair : group.pairs) {
      const std::string meshes = std::isfinite(pair->meshDistance) ? millimetres(pair->meshDistance) : "-";
      const std::string& why = byCause ? pair->cause : pair->reason;
      add({pair->link1 + " - " + pair->link2, millimetres(pair->answer.distance),
           byCause ? meshes : hullCell(*pair), millimetres(pair->overCover1 + pair->overCover2),
           why.empty() ? "-" : why},
          timed ? report.trajectory->timeText(pair->time) : "", steepest(*pair));
      gaps |= !std::isfinite(pair->meshDistance) || pair->cause.empty();
    }
  }
  return "\n" + table.text() + unshown(static_cast<std::size_t>(report.checked), top) +
         "\ncover: how much closer the two smooth surfaces are than their hulls, along the normal\n" +
         (!byCause ? ""
                   : std::string("meshes: the distance of the meshes themselves, 0 where they meet\n") +
                         (gaps ? "-: the volumes are far enough apart\n" : ""));
}

}  // namespace fcl_stpbv::report
