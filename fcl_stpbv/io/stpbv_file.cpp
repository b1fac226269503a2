// The `.stpbv` format: a header, vertices, faces, `end`. Numbers are the shortest decimals that read back
// exactly; on reading, edges and patches are rebuilt and the faces checked against their balls.

#include "fcl_stpbv/error_place.h"
#include "fcl_stpbv/io/atomic_write.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/io/volume_files.h"

namespace fcl_stpbv {
namespace {

using namespace detail;

constexpr std::string_view kMagic = "stpbv";
constexpr int kVersion = 1;

// The shortest possible lines.
constexpr std::size_t kVertexLine = 6;  // "0 0 0\n"
constexpr std::size_t kFaceLine = 8;    // "3 0 1 2\n"
constexpr std::size_t kCornerBytes = 2;

std::string stpbvText(const StpBv& volume) {
  std::string text = std::string(kMagic) + " " + std::to_string(kVersion) + "\nr ";
  appendNumber(text, volume.radii().r);
  text += "\nR ";
  appendNumber(text, volume.radii().R);
  text += "\nvertices " + std::to_string(volume.vertexCount()) + "\n";
  for (const Eigen::Vector3d& vertex : volume.vertices()) {
    appendVector(text, vertex);
    text += '\n';
  }
  text += "faces " + std::to_string(volume.faceCount()) + "\n";
  for (const StpBv::Ring& ring : volume.faces()) {
    text += std::to_string(ring.size());
    for (int vertex : ring) text += " " + std::to_string(vertex);
    text += '\n';
  }
  // The last word tells a complete file from one that was cut off inside its last number.
  return text + "end\n";
}

void readHeader(TextScanner& in) {
  const std::string_view magic = in.token("the word 'stpbv'");
  if (magic != kMagic) in.fail("not an .stpbv file, expected it to begin with 'stpbv 1'");
  const long version = in.integer("the format's version", 0, 1000000);
  if (version != kVersion) {
    in.fail("format version " + std::to_string(version) + ", this library reads version " +
            std::to_string(kVersion));
  }
}

StpBv::Ptr volumeOfStpbv(const std::string& text, const std::string& name) {
  TextScanner in(text, name);
  readHeader(in);
  StpBvOptions options;
  in.keyword("r");
  options.r = in.number("the small radius r");
  in.keyword("R");
  options.R = in.number("the big radius R");

  in.keyword("vertices");
  std::vector<Eigen::Vector3d> vertices(
      static_cast<std::size_t>(in.count("number of vertices", 1, kVertexLine)));
  for (Eigen::Vector3d& vertex : vertices) vertex = in.vector("a vertex coordinate");

  in.keyword("faces");
  std::vector<StpBv::Ring> faces(static_cast<std::size_t>(in.count("number of faces", 0, kFaceLine)));
  for (StpBv::Ring& ring : faces) {
    ring.resize(static_cast<std::size_t>(in.count("number of a face's vertices", 3, kCornerBytes)));
    for (int& vertex : ring) {
      vertex = static_cast<int>(in.integer("a face's vertex", 0, static_cast<long>(vertices.size()) - 1));
    }
  }
  in.keyword("end");
  in.end();

  return within(name, [&] { return StpBv::assemble(std::move(vertices), std::move(faces), options); });
}

}  // namespace

void saveStpBv(const std::string& path, const StpBv& volume) { atomicWrite(path, stpbvText(volume)); }

void saveStpBv(std::ostream& out, const StpBv& volume) {
  writeStream(out, stpbvText(volume), "an .stpbv volume");
}

StpBv::Ptr loadStpBv(const std::string& path) { return volumeOfStpbv(readText(path), path); }

StpBv::Ptr loadStpBv(std::istream& in, const std::string& name) {
  return volumeOfStpbv(readText(in, name), name);
}

bool looksLikeStpBv(std::string_view text) { return text.substr(0, kMagic.size()) == kMagic; }

}  // namespace fcl_stpbv
