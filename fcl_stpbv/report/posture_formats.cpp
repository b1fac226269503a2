// A posture as text and as JSON.
#include "fcl_stpbv/report/posture_formats.h"

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/report/json_values.h"
#include "fcl_stpbv/report/text_table.h"
#include "fcl_stpbv/text_cells.h"

namespace fcl_stpbv::report {
namespace {

using detail::formatted;

nlohmann::json list(const std::vector<Violation>& violations) {
  nlohmann::json items = nlohmann::json::array();
  for (const Violation& v : violations)
    items.push_back({{"constraint", v.name}, {"amount", v.amount}, {"unit", v.unit}});
  return items;
}

std::string run(const Posture& posture) {
  return formatted("%.1f ms, %d iterations, %d start%s, %ld distances, %ld gradients, cost %.4f",
                   posture.seconds * 1e3, posture.iterations, posture.starts, posture.starts == 1 ? "" : "s",
                   posture.distanceCalls, posture.gradientCalls, posture.cost);
}

// The bodies that are split, and their numbers of parts.
std::map<std::string, int> partsOf(const PostureReport& report) {
  std::map<std::string, int> parts;
  for (const Body& body : report.scene.geometry->bodies)
    if (body.parts > 0) parts[body.name] = body.parts;
  return parts;
}

std::string bulleted(const std::vector<Violation>& violations) {
  std::string text;
  for (const Violation& v : violations) text += "  " + detail::printable(v.name) + ": " + amountOf(v) + "\n";
  return text;
}

}  // namespace

std::string amountOf(const Violation& violation) {
  if (violation.unit == "m") return formatted("%.3f mm", 1e3 * violation.amount);
  return formatted("%.4f", violation.amount) + (violation.unit.empty() ? "" : " " + violation.unit);
}

std::string verdictOf(const PostureReport& report) {
  std::string text = report.posture.feasible ? "feasible" : "not feasible";
  if (report.ignoresPairs)
    text += " without regard to collisions, " + std::to_string(report.colliding) + " of " +
            detail::counted(report.pairs.size(), "pair") + " in collision";
  return text + " (" + report.posture.status + ")";
}

std::string toText(const PostureReport& report) {
  const Posture& posture = report.posture;
  std::size_t obstacles = 0;
  for (const CheckedPair& pair : report.pairs) obstacles += pair.obstacle;
  std::string text = verdictOf(report) + ": " + run(posture) + "\n";
  for (const std::string& shape : report.skipped)
    text += "LEFT OUT, NOT CHECKED: " + detail::printableLines(shape) + "\n";
  text += detail::counted(report.pairs.size(), "pair") + formatted(", %zu with obstacles\n", obstacles);
  if (report.closest)
    text += "closest: " + detail::printable(report.closest->name) +
            formatted(", %.4g mm %s\n", 1e3 * std::abs(report.closest->distance),
                      report.closest->distance < 0 ? "deep" : "apart");
  for (const auto& [body, count] : partsOf(report))
    text += detail::printable(body) + formatted(" in %d parts\n", count);
  if (report.withoutCollisions)
    text += std::string("without collisions ") +
            (report.withoutCollisions->feasible ? "feasible: " : "not feasible: ") +
            run(*report.withoutCollisions) + "\n";
  if (!posture.feasible) {
    text += "violated in the best posture found:\n" + bulleted(posture.violations);
    text += "in conflict; each with its violation at the least-squares compromise:\n" +
            bulleted(posture.conflict);
    for (const std::string& limit : posture.conflictLimits)
      text += "  at its limit: " + detail::printable(limit) + "\n";
  }
  if (!posture.active.empty()) text += "active:\n";
  for (const std::string& name : posture.active) text += "  " + detail::printable(name) + "\n";
  TextTable values("lr");
  for (int i = 0; i < report.kinematics->size(); ++i)
    values.add({report.kinematics->names()[static_cast<std::size_t>(i)], detail::fixed(posture.q[i], 6)});
  return text + "posture (rad, m):\n" + values.text(2);
}

std::string toJson(const PostureReport& report) {
  const Posture& posture = report.posture;
  nlohmann::json document{{"feasible", posture.feasible},
                          {"status", posture.status},
                          {"seconds", posture.seconds},
                          {"iterations", posture.iterations},
                          {"starts", posture.starts},
                          {"distance_calls", posture.distanceCalls},
                          {"gradient_calls", posture.gradientCalls},
                          {"pairs", report.pairs.size()},
                          {"parts", partsOf(report)},
                          {"cost", posture.cost},
                          {"q", byName(posture.q, *report.kinematics)},
                          {"warnings", report.warnings},
                          {"skipped", report.skipped},
                          {"violations", list(posture.violations)},
                          {"active", posture.active},
                          {"conflict", list(posture.conflict)},
                          {"conflict_limits", posture.conflictLimits}};
  document["closest"] = nullptr;
  if (report.closest)
    document["closest"] = {{"pair", report.closest->name}, {"distance", report.closest->distance}};
  if (report.withoutCollisions)
    document["without_collisions"] = {{"feasible", report.withoutCollisions->feasible},
                                      {"seconds", report.withoutCollisions->seconds},
                                      {"iterations", report.withoutCollisions->iterations},
                                      {"cost", report.withoutCollisions->cost}};
  return document.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace fcl_stpbv::report
