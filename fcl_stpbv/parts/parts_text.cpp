// The format: a line of counts, then for each part its two bounds and its points. The word `end` shows that
// the text was not cut off.
#include "fcl_stpbv/parts/parts_text.h"

#include "fcl_stpbv/io/text_scanner.h"

namespace fcl_stpbv::detail {
namespace {

constexpr std::size_t kPointBytes = 6;  // shortest point: "0 0 0\n"
constexpr std::size_t kPartBytes = 20;  // shortest part: two bounds of five numbers

void append(std::string& text, const MeshExcess& excess) {
  for (const double bound : {excess.upper, excess.lower}) {
    appendNumber(text, bound);
    text += ' ';
  }
  appendVector(text, excess.where);
  text += '\n';
}

double length(TextScanner& in, const char* what) {
  const double value = in.number(what);
  if (value < 0) in.fail(std::string(what) + " is less than 0");
  return value;
}

MeshExcess excessFrom(TextScanner& in) {
  MeshExcess excess;
  excess.upper = length(in, "an upper bound");
  excess.lower = length(in, "a lower bound");
  excess.where = in.vector("a place");
  return excess;
}

}  // namespace

std::string toText(const ConvexParts& parts) {
  std::string text = "parts " + std::to_string(parts.parts.size()) + " pieces " +
                     std::to_string(parts.pieces) + " closed " + std::to_string(parts.closedPieces) +
                     " slack ";
  for (const double value : {parts.slack, parts.excess, parts.openExcess}) {
    appendNumber(text, value);
    text += ' ';
  }
  text += '\n';
  for (const ConvexPart& part : parts.parts) {
    append(text, part.excess);
    append(text, part.openExcess);
    text += std::to_string(part.points.size()) + "\n";
    for (const Eigen::Vector3d& p : part.points) {
      appendVector(text, p);
      text += '\n';
    }
  }
  return text + "end\n";
}

ConvexParts partsFromText(const std::string& text, const std::string& name) {
  TextScanner in(text, name);
  ConvexParts parts;
  in.keyword("parts");
  parts.parts.resize(static_cast<std::size_t>(in.count("number of parts", 0, kPartBytes)));
  in.keyword("pieces");
  parts.pieces = static_cast<int>(in.integer("number of pieces", 0, 1000000000));
  in.keyword("closed");
  parts.closedPieces = static_cast<int>(in.integer("number of closed pieces", 0, parts.pieces));
  in.keyword("slack");
  parts.slack = length(in, "the slack");
  parts.excess = length(in, "the excess");
  parts.openExcess = length(in, "the open excess");
  for (ConvexPart& part : parts.parts) {
    part.excess = excessFrom(in);
    part.openExcess = excessFrom(in);
    part.points.resize(static_cast<std::size_t>(in.count("number of points", 1, kPointBytes)));
    for (Eigen::Vector3d& p : part.points) p = in.vector("a point");
  }
  in.keyword("end");
  in.end();
  return parts;
}

}  // namespace fcl_stpbv::detail
