// Checks OFF text against its header. Without this check, assimp replaces a wrong index by another one, and
// reads each line after the header as the next vertex or face.
#include <algorithm>
#include <cctype>

#include "fcl_stpbv/mesh/mesh_checks.h"
#include "fcl_stpbv/mesh/mesh_lines.h"

namespace fcl_stpbv::detail {
namespace {

// assimp leaves out faces with more corners.
constexpr long kMostCorners = 9;
// The size of assimp's buffer for a line.
constexpr std::size_t kLongestLine = 4095;

struct OffHeader {
  std::size_t coordinates = 3;  // coordinates of a vertex, with its weight
  std::size_t numbers = 3;      // numbers that every vertex must have
  bool colours = false;         // whether the header announces colours, of any number of numbers
  long vertices = 0, faces = 0;
};

class OffLines {
 public:
  OffLines(std::string_view text, const std::string& name) : lines_(text, name) {}

  void check() {
    const OffHeader header = readHeader();
    while (!ended_ && words_.empty()) nextLine();
    for (long i = 0; i < header.vertices; ++i, toNextItem()) {
      expectItem(i, header.vertices, "vertices");
      checkVertex(header);
    }
    for (long i = 0; i < header.faces; ++i, toNextItem()) {
      expectItem(i, header.faces, "faces");
      checkFace(header);
    }
    for (; !ended_; nextLine())
      if (!words_.empty())
        lines_.damaged("goes on after the " + std::to_string(header.vertices) + " vertices and " +
                       std::to_string(header.faces) + " faces that its header promises");
  }

 private:
  void nextLine() {
    ended_ = !lines_.next();
    words_.clear();
    if (!ended_) words_ = wordsOf(lines_.text().substr(0, lines_.text().find('#')));
  }

  void toNextItem() {
    do nextLine();
    while (!ended_ && lines_.text().empty());
  }

  std::string_view headerWord() {
    for (; words_.empty(); nextLine())
      if (ended_) lines_.damaged("ends within its header");
    const std::string_view word = words_.front();
    words_.erase(words_.begin());
    return word;
  }

  long headerCount(std::string_view word) {
    long count = 0;
    if (!readMeshIndex(word, count))
      lines_.damaged("got '" + std::string(word) + "', expected the numbers of vertices, faces and edges");
    return count;
  }

  OffHeader readHeader() {
    OffHeader header;
    std::string_view word = headerWord();
    // If the keyword is missing, assimp takes a leading 4 for a part of it.
    if (std::isdigit(static_cast<unsigned char>(word[0])) == 0 || word[0] == '4') {
      readKeyword(word, header);
      word = headerWord();
    }
    header.vertices = headerCount(word);
    header.faces = headerCount(headerWord());
    headerCount(headerWord());
    if (header.vertices == 0) lines_.damaged("has no vertices");
    return header;
  }

  // [ST][C][N][4][n]OFF
  void readKeyword(std::string_view word, OffHeader& header) {
    const auto takes = [&word](std::string_view prefix) {
      const bool has = word.substr(0, prefix.size()) == prefix;
      if (has) word.remove_prefix(prefix.size());
      return has;
    };
    std::size_t others = takes("ST") ? 2 : 0;
    header.colours = takes("C");
    others += (header.colours ? 4u : 0u) + (takes("N") ? 3u : 0u);
    const std::size_t weight = takes("4") ? 1 : 0;
    const bool otherDimension = takes("n");
    if (word != "OFF") lines_.refuse("an OFF file must begin with the word OFF, before its numbers");
    if (otherDimension) header.coordinates = static_cast<std::size_t>(headerCount(headerWord()));
    if (header.coordinates < 1 || header.coordinates > 3)
      lines_.refuse("vertices of " + std::to_string(header.coordinates) +
                    " dimensions, where 1 to 3 are read");
    header.coordinates += weight;
    header.numbers = header.coordinates + others;
  }

  // assimp skips only empty lines.
  void expectItem(long done, long promised, const std::string& items) {
    if (ended_)
      lines_.damaged("ends after " + std::to_string(done) + " of the " + std::to_string(promised) + " " +
                     items + " that its header promises");
    if (words_.empty())
      lines_.refuse("a comment or blanks among the " + items + " are taken for one of them; remove the line");
    if (lines_.text().size() > kLongestLine)
      lines_.refuse("a line of more than " + std::to_string(kLongestLine) +
                    " characters is not read; split it");
  }

  void checkVertex(const OffHeader& header) {
    // If the header has no word for colours, a colour of three or four numbers may follow.
    const std::size_t more = words_.size() - std::min(words_.size(), header.numbers);
    bool good = words_.size() >= header.numbers && (more == 0 || more == 3 || more == 4 || header.colours);
    for (std::size_t k = 0; good && k < header.coordinates; ++k) good = isMeshNumber(words_[k]);
    if (!good)
      lines_.damaged("a vertex must be " + std::to_string(header.numbers) + " finite numbers here, " +
                     kNumberForm);
  }

  void checkFace(const OffHeader& header) {
    long corners = 0;
    bool good = readMeshIndex(words_[0], corners) && corners > 0;
    if (good && corners > kMostCorners)
      lines_.refuse("a face of " + std::to_string(corners) + " vertices, where at most " +
                    std::to_string(kMostCorners) + " are read; export triangles");
    good = good && words_.size() > static_cast<std::size_t>(corners);
    for (std::size_t k = 1; good && k <= static_cast<std::size_t>(corners); ++k) {
      long vertex = 0;
      good = readMeshIndex(words_[k], vertex) && vertex < header.vertices;
    }
    if (!good)
      lines_.damaged("a face must be the number of its vertices and as many indices, each from 0 to " +
                     std::to_string(header.vertices - 1));
  }

  MeshLines lines_;
  MeshWords words_;  // the words of the line that are not taken yet
  bool ended_ = false;
};

}  // namespace

void checkOff(std::string_view text, const std::string& name) { OffLines(text, name).check(); }

}  // namespace fcl_stpbv::detail
