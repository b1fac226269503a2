// Damaged meshes are refused with the line, and a mesh cannot be used to read other files.
#include <sys/resource.h>
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <new>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/child_process.h"
#include "fcl_stpbv/mesh/mesh_file.h"
#include "test/reference/volume_files.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Catch::Matchers::Contains;

namespace {

std::string loaded(const std::string& path) {
  return refusal([](const std::string& p) { loadPoints(p); }, path);
}

std::string dae(const std::string& unit, const std::string& numbers, const std::string& corners) {
  return "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
         "version=\"1.4.1\">\n"
         "<asset>\n" +
         unit +
         "\n</asset><library_geometries><geometry id=\"g\"><mesh><source id=\"p\">\n<float_array id=\"pa\" "
         "count=\"9\">" +
         numbers +
         "</float_array><technique_common><accessor source=\"#pa\" count=\"3\" stride=\"3\"><param "
         "name=\"X\" "
         "type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor>"
         "</technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" "
         "source=\"#p\"/></vertices>"
         "<triangles count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>" +
         corners +
         "</p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene "
         "id=\"s\"><node>"
         "<instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes><scene>"
         "<instance_visual_scene url=\"#s\"/></scene></COLLADA>";
}

}  // namespace

TEST_CASE("a damaged mesh as text is refused with its line") {
  const TemporaryFolder folder;
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n", off = "OFF\n3 1 3\n0 0 0\n1 0 0\n";
  const std::string good = "0 0 0 1 0 0 0 1 0";
  const auto stl = [](const std::string& vertex) {
    return "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n" + vertex;
  };
  struct Case {
    std::string name, text, line;
  };
  for (const Case& one :
       std::vector<Case>{{"cut.obj", obj + "v 0 1", ":4: "},
                         {"comma.obj", "v 0 0 0\nv 1,5 0 0\nv 0 1 0\nf 1 2 3\n", ":2: "},
                         {"word.obj", "v 0 0 zero\n", ":1: "},
                         {"before.obj", obj + "f 1 2 -4\n", ":4: "},
                         {"past.obj", obj + "f 1 2 3\nf 1 2 4\n", ":5: "},
                         {"zero.obj", obj + "f 0 1 2\n", ":4: "},
                         {"empty.obj", obj + "f\n", ":4: "},
                         {"comma.stl", stl("vertex 0 1,5 0\nendloop\nendfacet\nendsolid s\n"), ":6: "},
                         {"cut.stl", stl("vertex 0 1"), ":6: "},
                         {"ends.stl", stl("vertex 0 1 0\n"), ":6: "},
                         {"two.stl", stl("endloop\nendfacet\nendsolid s\n"), ":7: "},
                         {"comma.off", off + "0 1,5 0\n3 0 1 2\n", ":5: "},
                         {"zero.dae", dae("<unit name=\"x\" meter=\"0\"/>", good, "0 1 2"), ":3: "},
                         {"negative.dae", dae("<unit meter=\"-1\"/>", good, "0 1 2"), ":3: "},
                         {"word.dae", dae("<unit meter=\"abc\"/>", good, "0 1 2"), ":3: "},
                         {"comma.dae", dae("", "0 0 0 1,5 0 0 0 1 0", "0 1 2"), ":5: "},
                         {"index.dae", dae("", good, "0 1 -7"), ""},
                         {"past.dae", dae("", good, "0 1 7"), ""}}) {
    CAPTURE(one.name);
    put(folder / one.name, one.text);
    CHECK_THAT(loaded(folder / one.name), Contains(one.name + one.line));
  }
}

TEST_CASE("a message about a damaged mesh does not quote the file to its end") {
  const TemporaryFolder folder;
  std::string text = "solid a\nfacet normal x 0 1\n";
  for (int i = 0; i < 1000; ++i)
    text += "outer loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nfacet normal 0 0 1\n";
  text += "outer loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
  put(folder / "t.stl", text);
  const std::string message = refusal([](const std::string& path) { loadPoints(path); }, folder / "t.stl");
  CHECK_THAT(message, Catch::Matchers::Contains("cannot be read as a mesh (Cannot parse string \"x 0 1"));
  CHECK(message.size() < 600);
}

TEST_CASE("sound meshes as text are read, whatever their writer's habits") {
  const TemporaryFolder folder;
  put(folder / "a.obj",
      "# c\r\nv 0 0 0 0.5 0.5 0.5\r\nv +1 0 0 1 1 1\r\nv 0 1e0 0 1 1 1\r\ng a b\r\nf -3/1/1 -2//2 "
      "\\\r\n-1\r\n");
  put(folder / "b.stl",
      "solid s t\n facet normal nan nan nan\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 "
      "0\n"
      "  endloop\n endfacet\nendsolid\n");
  put(folder / "c.dae", dae("<unit name=\"millimeter\" meter = '1e-3'/>", "0 0 0 1 0 0 0 1 0", "0 1 2"));
  put(folder / "d.dae", dae("", "0 0 0 1 0 0 0 1 0", "0 1 2"));
  for (const char* name : {"a.obj", "b.stl", "c.dae", "d.dae"}) {
    CAPTURE(name);
    CHECK(loaded(folder / name) == "");
    CHECK(loadPoints(folder / name).size() == 3);
  }
}

TEST_CASE("a mesh opens no file but glTF's own buffers beside or below it, and no word of one is told") {
  const TemporaryFolder folder;
  const std::string secret = "password hunter2";
  std::filesystem::create_directory(folder / "meshes");
  put(folder / "secret.mtl", secret);
  put(folder / "meshes/near.mtl", secret);
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  for (const char* library : {"near.mtl", "../secret.mtl", "/etc/passwd", "/dev/zero"}) {
    put(folder / "meshes/m.obj", std::string("mtllib ") + library + "\n" + triangle);
    CHECK(loaded(folder / "meshes/m.obj") == "");
  }
  const auto gltf = [](const std::string& uri) {
    return "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}"
           "],"
           "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"accessors\":[{\"bufferView\":"
           "0,"
           "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"max\":[1,1,0],\"min\":[0,0,0]}],"
           "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,\"uri\":\"" +
           uri + "\"}]}";
  };
  const float numbers[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::string bytes(reinterpret_cast<const char*>(numbers), sizeof numbers);
  put(folder / "meshes/near.bin", bytes);
  put(folder / "far.bin", bytes);
  put(folder / "meshes/m.gltf", gltf("near.bin"));
  CHECK(loaded(folder / "meshes/m.gltf") == "");
  for (const std::string& far : {std::string("../far.bin"), folder / "far.bin", folder / "secret.mtl"}) {
    put(folder / "meshes/m.gltf", gltf(far));
    const std::string message = loaded(folder / "meshes/m.gltf");
    CHECK(message != "");
    CHECK_THAT(message, !Contains("hunter2"));
  }
}

TEST_CASE("a mesh that is a pipe or a device is refused at once") {
  const TemporaryFolder folder;
  REQUIRE(::mkfifo((folder / "pipe.stl").c_str(), 0600) == 0);
  CHECK_THAT(loaded(folder / "pipe.stl"), Contains("pipe or a device"));
  CHECK_THAT(loaded("/dev/zero"), Contains("pipe or a device"));
}

TEST_CASE("a file for which there is no memory is not called damaged") {
  const auto read = [](bool little) {
    return refusal(
        [little](const std::string& name) {
          inChildProcess(name, [little](ChildLimits& limits) -> std::string {
            constexpr std::size_t kMost = std::size_t(1) << 50;  // bytes; enough for the program itself
            const rlimit most{kMost, kMost};
            if (little) ::setrlimit(RLIMIT_AS, &most);
            limits.allow(kMost);
            throw std::bad_alloc();
          });
        },
        "m.stl");
  };
  CHECK_THAT(read(true), Contains("m.stl: memory ran out while it was read"));
  CHECK_THAT(read(false), Contains("m.stl: takes more memory to read than a file of its size can need"));
}
