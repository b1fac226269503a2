// What a hostile mesh or robot description may cost: an error, or points, in memory and time bounded by the
// file's size, and nothing written.
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/child_process.h"
#include "fcl_stpbv/mesh/mesh_file.h"
#include "fcl_stpbv/mesh/passing_error.h"
#include "fcl_stpbv/robot/robot_model.h"
#include "test/reference/shapes.h"
#include "test/reference/volume_files.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

namespace {

// The address sanitizer's allocator reserves its whole address space when the program starts, so a limit on
// that space has no effect on it. It also keeps freed memory for a while.
#ifdef __SANITIZE_ADDRESS__
constexpr bool kMemoryIsMeasured = false;
#else
constexpr bool kMemoryIsMeasured = true;
#endif

/// The cost of a call, with its child processes: processor time (s), and memory above what was in use before
/// (bytes).
struct Cost {
  bool ended = false, refused = false;
  double seconds = 0, bytes = 0;
};

double residentNow() {
  double whole = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> whole >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

template <class Call>
Cost costOf(Call call) {
  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  const pid_t child = ::fork();
  if (child == 0) {
    Cost cost;
    const double before = residentNow();
    try {
      call();
    } catch (const Error&) {
      cost.refused = true;
    }
    double peak = 0;
    for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
      rusage used{};
      ::getrusage(who, &used);
      peak = std::max(peak, 1024.0 * static_cast<double>(used.ru_maxrss));
      cost.seconds += static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                      1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
    }
    cost.bytes = std::max(0.0, peak - before);
    cost.ended = true;
    ::_exit(::write(ends[1], &cost, sizeof cost) == sizeof cost ? 0 : 1);
  }
  ::close(ends[1]);
  Cost cost;
  if (::read(ends[0], &cost, sizeof cost) != sizeof cost) cost.ended = false;
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  return cost;
}

std::string repeated(int count, const std::string& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

/// A COLLADA triangle with the given counts, library and scene.
std::string dae(const std::string& floats, const std::string& stride, const std::string& triangles,
                const std::string& scene, const std::string& library = "") {
  return "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
         "version=\"1.4.1\">"
         "<library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"pa\" count=\"" +
         floats +
         "\">0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source=\"#pa\" count=\"3\" "
         "stride=\"" +
         stride +
         "\"><param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" "
         "type=\"float\"/>"
         "</accessor></technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" "
         "source=\"#p\"/>"
         "</vertices><triangles count=\"" +
         triangles +
         "\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 "
         "2</p></triangles></mesh></geometry>"
         "</library_geometries>" +
         library + "<library_visual_scenes><visual_scene id=\"s\">" + scene +
         "</visual_scene></library_visual_scenes><scene><instance_visual_scene "
         "url=\"#s\"/></scene></COLLADA>";
}
const std::string kInstance = "<node><instance_geometry url=\"#g\"/></node>";

/// Twelve nodes, each of which contains the one before ten times.
std::string bomb() {
  std::string library = "<library_nodes><node id=\"n0\"><instance_geometry url=\"#g\"/></node>";
  for (int i = 1; i < 12; ++i)
    library += "<node id=\"n" + std::to_string(i) + "\">" +
               repeated(10, "<instance_node url=\"#n" + std::to_string(i - 1) + "\"/>") + "</node>";
  return library + "</library_nodes>";
}

/// A chain or a "bomb" of glTF nodes: each node contains the next one `fold` times.
std::string gltf(int nodes, int fold) {
  std::string text = "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[";
  for (int i = 0; i + 1 < nodes; ++i) {
    const std::string next = std::to_string(i + 1);
    text += "{\"children\":[" + next + repeated(fold - 1, "," + next) + "]},";
  }
  return text + "{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{}}]}]}";
}

std::string little(std::uint32_t value) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> 8 * i);
  return bytes;
}

struct Hostile {
  std::string name, content;
};

std::vector<Hostile> hostileMeshes() {
  const std::string corners = "0 0 0\n1 0 0\n0 1 0\n", triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 ";
  return {
      {"count.off", "OFF\n4000000000 1 3\n" + corners + "3 0 1 2\n"},
      {"faces.off", "OFF\n3 400000000 3\n" + corners + "3 0 1 2\n"},
      {"corners.off", "OFF\n3 1 3\n" + corners + "400000000 0 1 2\n"},
      {"count.stl", std::string(80, ' ') + little(4294967295u) + std::string(200, '\1')},
      {"solids.stl", repeated(20000, "solid a\nendsolid a\n")},
      {"index.obj", triangle + "2000000000\n"},
      {"past.obj", triangle + "-2000000000\n"},
      {"device.obj", "mtllib /dev/zero\n" + triangle + "3\n"},
      {"fifo.obj", "mtllib fifo\n" + triangle + "3\n"},
      {"lines.obj", repeated(50000, "v 0 0 0 \\\n")},
      {"groups.obj", repeated(20000, "g a b c\n") + triangle + "3\n"},
      {"name.ply", "ply\nformat ascii 1.0\nelement 4000000000 1\nproperty float x\nend_header\n0\n"},
      {"comment.ply", "ply\ncomment 4000000000\nformat ascii 1.0\ncomment 4000000000\nend_header\n"},
      {"count.ply", "ply\nformat ascii 1.0\nelement vertex 2000000000\nend_header\n"},
      {"floats.dae", dae("4000000000", "3", "1", kInstance)},
      {"stride.dae", dae("9", "400000000", "1", kInstance)},
      {"triangles.dae", dae("9", "3", "400000000", kInstance)},
      {"deep.dae", dae("9", "3", "1", repeated(100000, "<node>") + kInstance + repeated(100000, "</node>"))},
      {"wide.dae", dae("9", "3", "1", repeated(5000, kInstance))},
      {"bomb.dae", dae("9", "3", "1", "<node><instance_node url=\"#n11\"/></node>", bomb())},
      {"loop.dae", dae("9", "3", "1", "<node><instance_node url=\"#n\"/></node>",
                       "<library_nodes><node id=\"n\"><instance_node url=\"#n\"/></node></library_nodes>")},
      {"chain.gltf", gltf(20000, 1)},
      {"bomb.gltf", gltf(12, 10)},
      {"deep.gltf",
       "{\"asset\":{\"version\":\"2.0\"},\"x\":" + repeated(200000, "[") + repeated(200000, "]") + "}"},
      {"chunk.glb",
       "glTF" + little(2) + little(40) + little(4000000000u) + "JSON{\"asset\":{\"version\":\"2.0\"}}"}};
}

}  // namespace

TEST_CASE("a hostile mesh costs an error, and memory and time in proportion to its size") {
  const TemporaryFolder folder;
  REQUIRE(::mkfifo((folder / "fifo").c_str(), 0600) == 0);
  int refused = 0;
  for (const Hostile& mesh : hostileMeshes()) {
    const std::string path = folder / mesh.name;
    put(path, mesh.content);
    const auto files = folder.files();
    const Cost cost = costOf([&] { loadPoints(path); });
    CAPTURE(mesh.name, mesh.content.size(), cost.seconds, cost.bytes);
    CHECK(cost.ended);
    // The limits of child_process.cpp, and the same again for the mesh in this process.
    const double size = static_cast<double>(mesh.content.size());
    if (kMemoryIsMeasured) CHECK(cost.bytes <= 2 * (256e6 + 256 * size));
    CHECK(cost.seconds <= 2 * (5 + 5e-6 * size));
    refused += cost.refused;
    CHECK(contentOf(path) == mesh.content);
    CHECK(folder.files() == files);
  }
  CHECK(refused >= 15);
}

TEST_CASE("a damaged mesh of any format costs an error or gives points") {
  const TemporaryFolder folder;
  Random random(5);
  const TriangleMesh mesh = tessellate(*StpBv::build(box(0.2, 0.3, 0.5)), 1);
  for (const char* name : {"m.obj", "m.stl", "m.glb", "m.dae"}) {
    const std::string path = folder / name;
    if (std::string(name) == "m.dae")
      put(path, dae("9", "3", "1", kInstance));
    else
      saveMesh(path, mesh);
    const std::string whole = contentOf(path);
    for (int i = 0; i < 40; ++i) {
      std::string damaged = whole;
      const auto somewhere = [&] {
        return static_cast<std::size_t>(
            random.below(std::min(static_cast<int>(whole.size()), i % 2 ? 1000000 : 400)));
      };
      if (i % 4 == 0)
        damaged.resize(somewhere());
      else
        for (int k = 0; k < 3; ++k) {
          char& c = damaged[somewhere()];
          c = static_cast<char>(c ^ (1 << random.below(8)));
        }
      put(path, damaged);
      CAPTURE(name, i);
      const std::string message = refusal([](const std::string& p) { loadPoints(p); }, path);
      CHECK((message.empty() || message.find(path) == 0));
    }
  }
}

TEST_CASE("a hostile robot description costs memory and time in proportion to its size") {
  const std::string box = "<box size=\"1 1 1\"/>";
  const std::string good = robot(test::link("base", box) + test::link("arm", box) +
                                 joint("shoulder", "revolute", "base", "arm", "<axis xyz=\"0 1 0\"/>"));
  std::vector<std::string> texts{
      good,
      robot(repeated(5000, "<link name=\"a\"/>")),
      robot("<link name=\"" + std::string(2000000, 'a') + "\"/>"),
      robot(repeated(100000, "<link>") + repeated(100000, "</link>")),
      robot(repeated(100000, "<!-- -->")),
      robot("<link name=\"a\"" + repeated(100000, " a=''") + "/>"),
      robot(test::link("a", "<sphere radius=\"1e999\"/>")),
      robot(test::link("a", "<mesh filename=\"/dev/zero\"/>")),
      std::string(1000000, '<'),
      "<!DOCTYPE r [<!ENTITY a \"&b;&b;\"><!ENTITY b \"&a;&a;\">]><robot name=\"&a;\"/>"};
  std::string wide = test::link("l0", box);
  for (int i = 1; i < 3000; ++i)
    wide += test::link("l" + std::to_string(i), box) +
            joint("j" + std::to_string(i), "fixed", "l" + std::to_string(i / 2), "l" + std::to_string(i), "");
  texts.push_back(robot(wide));
  Random random(7);
  for (int i = 0; i < 100; ++i) {
    std::string text = good;
    if (i % 3 == 0)
      text.resize(static_cast<std::size_t>(random.below(static_cast<int>(good.size()))));
    else
      for (int k = 0; k < 2; ++k)
        text[static_cast<std::size_t>(random.below(static_cast<int>(good.size())))] ^=
            static_cast<char>(1 << random.below(8));
    texts.push_back(text);
  }
  int refused = 0;
  for (const std::string& text : texts) {
    const Cost cost = costOf([&] { parseUrdf(text, "hostile.urdf"); });
    CAPTURE(text.substr(0, 300), text.size(), cost.seconds, cost.bytes);
    CHECK(cost.ended);
    // Measured: up to 50 bytes and 2 us per byte, without sanitizers.
    if (kMemoryIsMeasured) CHECK(cost.bytes <= 64e6 + 500 * static_cast<double>(text.size()));
    CHECK(cost.seconds <= 2 + 50e-6 * static_cast<double>(text.size()));
    refused += cost.refused;
  }
  CHECK(refused >= 60);
}

TEST_CASE("a file whose reader is killed from outside is not called damaged") {
  const auto read = [] {
    detail::inChildProcess("m.stl", [](detail::ChildLimits&) -> std::string {
      std::raise(SIGKILL);
      return "";
    });
  };
  CHECK_THROWS_AS(read(), detail::PassingError);
  CHECK_THROWS_WITH(read(), Catch::Contains("m.stl: its reader was killed"));
}
