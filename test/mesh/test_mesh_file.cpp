// Reading and writing meshes: every format gives the same points, and the error for a damaged file names it.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <set>
#include <sstream>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/volume_files.h"
#include "fcl_stpbv/mesh/mesh_file.h"
#include "fcl_stpbv/volume/stp_bv.h"
#include "test/reference/shapes.h"
#include "test/reference/volume_files.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Vector3d;

namespace {

// A tetrahedron with a different extent along each axis.
const std::vector<Vector3d> kCorners{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 4}};
const std::array<std::array<int, 3>, 4> kTriangles{{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};

std::string corner(int i) {
  std::ostringstream text;
  text << kCorners[static_cast<std::size_t>(i)].transpose();
  return text.str();
}

std::string asciiStl() {
  std::string text = "solid t\n";
  for (const auto& triangle : kTriangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (int i : triangle) text += "vertex " + corner(i) + "\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid t\n";
}

std::string listed(const std::string& head, const std::string& vertexPrefix, const std::string& facePrefix,
                   int base) {
  std::string text = head;
  for (int i = 0; i < 4; ++i) text += vertexPrefix + corner(i) + "\n";
  for (const auto& t : kTriangles) {
    text += facePrefix;
    for (int i : t) text += " " + std::to_string(i + base);
    text += "\n";
  }
  return text;
}

std::string obj() { return listed("", "v ", "f", 1); }
std::string off() { return listed("OFF\n4 4 6\n", "", "3", 0); }
std::string ply() {
  return listed(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 4\nproperty list uchar int vertex_indices\nend_header\n",
      "", "3", 0);
}

// Two instances of the tetrahedron. The second one is moved and turned by a quarter about z, below another
// node.
std::string collada(const std::string& asset) {
  std::string positions, indices;
  for (int i = 0; i < 4; ++i) positions += corner(i) + " ";
  for (const auto& t : kTriangles)
    for (int i : t) indices += std::to_string(i) + " ";
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>)" +
         asset +
         R"(</asset><library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="12">)" +
         positions +
         R"(</float_array><technique_common><accessor source="#a" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="4">
<input semantic="VERTEX" source="#v" offset="0"/><p>)" +
         indices +
         R"(</p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s">
<node id="one"><instance_geometry url="#g"/></node>
<node id="two"><translate>10 20 30</translate><node id="three"><rotate>0 0 1 90</rotate><instance_geometry url="#g"/></node></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

bool samePoints(std::vector<Vector3d> a, std::vector<Vector3d> b, double tolerance) {
  const auto near = [&](const Vector3d& p, const std::vector<Vector3d>& all) {
    return std::any_of(all.begin(), all.end(),
                       [&](const Vector3d& q) { return (p - q).norm() <= tolerance; });
  };
  return a.size() == b.size() &&
         std::all_of(a.begin(), a.end(), [&](const Vector3d& p) { return near(p, b); }) &&
         std::all_of(b.begin(), b.end(), [&](const Vector3d& p) { return near(p, a); });
}

// The mesh's enclosed volume, positive if its triangles face outwards.
double signedVolume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const auto at = [&](int k) {
      return mesh.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])];
    };
    sum += at(0).dot(at(1).cross(at(2))) / 6;
  }
  return sum;
}

}  // namespace

TEST_CASE("every format gives the same points and triangles") {
  const TemporaryFolder folder;
  const std::pair<std::string, std::string> files[] = {
      {"t.stl", asciiStl()}, {"t.obj", obj()}, {"t.off", off()}, {"t.ply", ply()}, {"T.OBJ", obj()}};
  for (const auto& [name, content] : files) {
    INFO(name);
    put(folder / name, content);
    const TriangleMesh mesh = loadMesh(folder / name);
    CHECK(samePoints(mesh.vertices, kCorners, 0));
    CHECK(mesh.triangles.size() == 4);
    CHECK(signedVolume(mesh) == Approx(8.0 / 6));
    CHECK(samePoints(loadPoints(folder / name), kCorners, 0));
  }
}

TEST_CASE("scale acts along each axis") {
  const TemporaryFolder folder;
  put(folder / "t.obj", obj());
  const std::vector<Vector3d> scaled{{0, 0, 0}, {0.5, 0, 0}, {0, -2, 0}, {0, 0, 0.004}};
  CHECK(samePoints(loadPoints(folder / "t.obj", {0.5, -1, 0.001}), scaled, 1e-15));
  const auto load = [&](const std::string& path) { loadPoints(path, {1, 0, 1}); };
  CHECK(refusal(load, folder / "t.obj").find(folder / "t.obj: a scale of 0") == 0);
}

TEST_CASE("a mesh that its unit or scale makes smaller than an atom is refused") {
  const TemporaryFolder folder;
  put(folder / "t.obj", obj());
  put(folder / "t-ch.txt", "3\n4\n0 0 0\n1 0 0\n0 2 0\n0 0 4\n");
  put(folder / "point.obj", "v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n");
  put(folder / "nano.dae", collada("<unit meter=\"1e-12\"/>"));
  for (const double scale : {1e-10, 1e-30, -1e-30, 1e-320}) {
    const auto load = [&](const std::string& path) { loadPoints(path, {scale, scale, scale}); };
    for (const char* name : {"t.obj", "t-ch.txt"})
      CHECK(refusal(load, folder / name).find(folder / name + ": is smaller than 1e-9 m along each axis") ==
            0);
    CHECK(refusal(load, folder / "point.obj") == "");
  }
  const auto load = [](const std::string& path) { loadPoints(path); };
  CHECK(refusal(load, folder / "nano.dae").find("is smaller than 1e-9 m") != std::string::npos);
  CHECK(loadPoints(folder / "t.obj", {1e-9, 1e-30, 1e-30}).size() == 4);  // long enough, but only just
}

TEST_CASE("a mesh so far from its origin that its shape would be rounded is refused") {
  const TemporaryFolder folder;
  const auto at = [&](double far) {
    std::string text;
    for (const Vector3d& p :
         {Vector3d(0, 0, 0), Vector3d(0.1, 0, 0), Vector3d(0, 0.1, 0), Vector3d(0, 0, 0.1)})
      text += "v " + std::to_string(p.x() + far) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) +
              "\n";
    put(folder / "t.obj", text + "f 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n");
    return refusal([](const std::string& path) { loadPoints(path); }, folder / "t.obj");
  };
  CHECK(at(0) == "");
  CHECK(at(-500) == "");
  for (const double far : {1e3, -1e4, 1e6, 1e9})
    CHECK(at(far).find(folder / "t.obj: is too far from its origin") == 0);
}

TEST_CASE("COLLADA: nodes and unit are applied, up_axis is not") {
  const TemporaryFolder folder;
  for (const std::string up :
       {"", "<up_axis>X_UP</up_axis>", "<up_axis>Y_UP</up_axis>", "<up_axis>Z_UP</up_axis>"}) {
    for (const double unit : {1.0, 0.001}) {
      INFO(up << " " << unit);
      std::ostringstream asset;
      asset << "<unit meter=\"" << unit << "\"/>" << up;
      put(folder / "t.dae", collada(asset.str()));
      std::vector<Vector3d> expected;
      for (const Vector3d& p : kCorners) {
        expected.push_back(unit * p);
        expected.push_back(unit * Vector3d(10 - p.y(), 20 + p.x(), 30 + p.z()));
      }
      CHECK(samePoints(loadPoints(folder / "t.dae"), expected, 1e-5 * unit));
    }
  }
}

TEST_CASE("a mesh is previewed in four formats and reads back") {
  const TemporaryFolder folder;
  const TriangleMesh mesh = tessellate(*StpBv::build(box(0.2, 0.3, 0.5)));
  for (const std::string name : {"p.obj", "p.stl", "p.ply", "p.glb", "P.STL"}) {
    INFO(name);
    CHECK(canSaveMesh(name));
    saveMesh(folder / name, mesh);
    const TriangleMesh back = loadMesh(folder / name);
    CHECK(samePoints(back.vertices, mesh.vertices, 1e-6));
    CHECK(back.triangles.size() == mesh.triangles.size());
    CHECK(signedVolume(back) == Approx(signedVolume(mesh)).epsilon(1e-4));
  }
  CHECK(folder.files().size() == 5);
  CHECK_FALSE(canSaveMesh("p.txt"));
  const auto save = [&](const std::string& path) { saveMesh(path, mesh); };
  CHECK(refusal(save, folder / "p.txt").find("use .obj, .stl, .ply or .glb") != std::string::npos);
  CHECK(refusal(save, folder / "none/p.obj").find("cannot be written") != std::string::npos);
}

TEST_CASE("a mesh that no file can hold is not written") {
  const TemporaryFolder folder;
  const TriangleMesh sound{kCorners, {kTriangles.begin(), kTriangles.end()}};
  TriangleMesh none = sound, below = sound, wild = sound, far = sound;
  none.triangles[1][2] = 5000000;
  below.triangles[0][0] = -1;
  wild.vertices[3].y() = std::nan("");
  far.vertices[2].z() = -1e39;
  for (const std::string name : {"p.obj", "p.stl", "p.ply", "p.glb"}) {
    INFO(name);
    const auto message = [&](const TriangleMesh& mesh) {
      return refusal([&](const std::string& path) { saveColoured(path, {sound, mesh}); }, folder / name);
    };
    for (const TriangleMesh& mesh : {none, below})
      CHECK(message(mesh).find("a triangle names a vertex that does not exist: there are 4") !=
            std::string::npos);
    CHECK(message(wild).find("vertex 3 has a coordinate that is no number or beyond single precision") !=
          std::string::npos);
    CHECK(message(far).find("vertex 2 has") != std::string::npos);
  }
  CHECK(folder.files().empty());
}

TEST_CASE("several meshes in colours of their own read back from each format") {
  const TemporaryFolder folder;
  const TriangleMesh near{box(0.2, 0.3, 0.5), {{0, 1, 2}, {4, 5, 6}, {7, 3, 1}}};
  TriangleMesh far = near;
  for (Vector3d& point : far.vertices) point += Vector3d(3, 2, 1);
  std::vector<Vector3d> all = near.vertices;
  all.insert(all.end(), far.vertices.begin(), far.vertices.end());
  for (const std::string name : {"p.obj", "p.stl", "p.ply", "p.glb"}) {
    INFO(name);
    saveColoured(folder / name, {near, far});
    const TriangleMesh back = loadMesh(folder / name);
    CHECK(samePoints(back.vertices, all, 1e-6));
    CHECK(back.triangles.size() == 6);
  }
}

TEST_CASE("files that hold no mesh are refused by name") {
  const TemporaryFolder folder;
  const auto load = [](const std::string& path) { loadPoints(path); };
  const auto refused = [&](const std::string& name, const std::string& content, const std::string& expected) {
    put(folder / name, content);
    const std::string message = refusal(load, folder / name);
    INFO(name << ": " << message);
    CHECK(message.find(folder / name) == 0);
    CHECK(message.find(expected) != std::string::npos);
  };
  CHECK(refusal(load, folder / "none.stl") == folder / "none.stl: no such file");
  CHECK(refusal(load, folder / "").find("is a folder") != std::string::npos);
  refused("empty.stl", "", "give a whole file");
  refused("noise.obj", std::string(100, '\1'), "");
  refused("t.unknown", "hello\n", "give a whole file");
  refused("t.amf", "<?xml version=\"1.0\"?><amf unit=\"inch\"/>", "convert it to STL or OBJ in metres");
  refused("t.fbx", "; FBX 7.4.0 project file\n", "convert it to STL or OBJ in metres");
  refused("t.3mf", "PK", "convert it to STL or OBJ in metres");
  refused("t.dxf", "0\nSECTION\n2\nENTITIES\n0\nENDSEC\n0\nEOF\n", "convert it to STL or OBJ in metres");
  refused("t.ogex", "Metric (key = \"distance\") {float {0.01}}\n", "convert it to STL or OBJ in metres");
  refused(
      "t.x3d",
      "<?xml version=\"1.0\"?><X3D><head><unit category=\"length\" conversionFactor=\"0.001\"/></head><Scene>"
      "<Shape><IndexedFaceSet coordIndex=\"0 1 2 -1\"><Coordinate point=\"0 0 0 1 0 0 0 1 0\"/>"
      "</IndexedFaceSet></Shape></Scene></X3D>",
      "convert it to STL or OBJ in metres");
  refused("t.txt", obj(), "t.txt:1:");
  refused("cut.off", "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1", "damaged");
  refused("nan.off", "OFF\n3 1 3\n0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n", "");
  refused("inf.ply",
          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
          "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1e999 0 0\n0 1 0\n3 0 "
          "1 2\n",
          "");
}

TEST_CASE(
    "a mesh whose first byte in a binary PLY would be a line feed's is written so that it can be read") {
  const TemporaryFolder folder;
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1.0 / 3, 0.1}}, {{0, 1, 2}}};
  int fed = 0;
  float x = 0.3f;
  for (int i = 0; i < 256; ++i, x = std::nextafter(x, 1.0f)) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &x, sizeof bits);
    if ((bits & 0xff) != '\n') continue;
    ++fed;
    mesh.vertices[0].x() = static_cast<double>(x);
    saveMesh(folder / "fed.ply", mesh);
    const std::vector<Vector3d> read = loadPoints(folder / "fed.ply");
    REQUIRE(read.size() == 3);
    CHECK(read[0].x() == static_cast<double>(x));
    CHECK((read[2] - mesh.vertices[2]).norm() < 1e-7);  // single precision
  }
  CHECK(fed == 1);
}

TEST_CASE("a PLY file cut off or with flipped bits is refused or read, in text and in binary") {
  const TemporaryFolder folder;
  saveMesh(folder / "b.ply", tessellate(*StpBv::build(box(0.2, 0.3, 0.5)), 1));
  Random random(9);
  for (const std::string& whole : {contentOf(folder / "b.ply"), ply()}) {
    const auto read = [&](const std::string& content) {
      put(folder / "d.ply", content);
      return refusal([](const std::string& path) { loadPoints(path); }, folder / "d.ply");
    };
    CHECK(read(whole).empty());
    CHECK(read(whole + "\n").empty());
    CHECK(read(whole + "3 0 1 2\n").find("holds more than the elements that the header promises") !=
          std::string::npos);
    for (int i = 0; i < 100; ++i) {
      const int size = static_cast<int>(whole.size());
      CHECK(read(whole.substr(0, static_cast<std::size_t>(random.below(size - 1)))).find(folder / "d.ply") ==
            0);
      std::string flipped = whole;
      char& c = flipped[static_cast<std::size_t>(random.below(i % 2 == 0 ? size : std::min(size, 300)))];
      c = static_cast<char>(c ^ (1 << random.below(8)));
      const std::string message = read(flipped);
      CHECK((message.empty() || message.find(folder / "d.ply") == 0));
    }
  }
}

TEST_CASE(
    "a PLY in binary whose values begin as a line feed does is refused, not read from the byte behind") {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& end, const std::string& first) {
    std::string content = "ply" + end + "format binary_little_endian 1.0" + end + "element vertex 4" + end;
    for (const char* name : {"x", "y", "z"}) content += std::string("property float ") + name + end;
    content += "end_header" + end + first;
    for (int i = 1; i < 12; ++i) content += i % 4 == 0 ? "\x3e\x80\x10\x3f" : "\x3d\x10\x80\x3e";
    put(folder / "b.ply", content);
    std::vector<Vector3d> points;
    const std::string message =
        refusal([&](const std::string& path) { points = loadPoints(path); }, folder / "b.ply");
    if (message.empty()) CHECK((points.size() == 3 || points.size() == 4));
    for (const Vector3d& p : points) CHECK((p.minCoeff() > 0.2 && p.maxCoeff() < 0.6));
    return message;
  };
  const std::string feed = "\n\x10\x80\x3e";  // slightly above 0.25
  CHECK(read("\n", feed).find(folder / "b.ply:7: the values in binary begin with a byte") == 0);
  CHECK(read("\n", "\r" + feed.substr(1)) == "");
  CHECK(read("\n", " " + feed.substr(1)) == "");
  CHECK(read("\r\n", feed) == "");
}

TEST_CASE("a polygon that cannot be split is refused, not read with a part of its triangles") {
  const TemporaryFolder folder;
  // A comb in a tilted plane: assimp leaves out 2 of its 12 m^2.
  put(folder / "comb.obj",
      "v 0 -0 -0\n"
      "v 0.02403695 -0.3935097 -0.9190062\n"
      "v -0.9741027 -0.4544796 -0.9190062\n"
      "v -0.9981396 -0.06096986 -0\n"
      "v -1.996279 -0.1219397 -0\n"
      "v -1.972242 -0.5154495 -0.9190062\n"
      "v -2.970382 -0.5764193 -0.9190062\n"
      "v -2.994419 -0.1829096 -0\n"
      "v -3.992558 -0.2438795 -0\n"
      "v -3.968521 -0.6373892 -0.9190062\n"
      "v -4.966661 -0.6983591 -0.9190062\n"
      "v -4.990698 -0.3048493 -0\n"
      "v -5.988838 -0.3658192 -0\n"
      "v -5.964801 -0.7593289 -0.9190062\n"
      "v -6.96294 -0.8202988 -0.9190062\n"
      "v -6.986977 -0.426789 -0\n"
      "v -7.985117 -0.4877589 -0\n"
      "v -8.009154 -0.09424916 0.9190062\n"
      "v -0.02403695 0.3935097 0.9190062\n"
      "f 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19\n");
  const auto load = [](const std::string& path) { loadMesh(path); };
  CHECK(refusal(load, folder / "comb.obj").find(folder / "comb.obj: a face of many corners") == 0);
}

TEST_CASE("the humanoid's meshes and their polyhedra are the same bodies") {
  const std::string robot = sharedFolder("robots/jvrc_description");
  if (robot.empty()) {
    WARN("skipped: ../shared/robots is missing");
    return;
  }
  for (const auto& entry : std::filesystem::directory_iterator(robot + "/convex/jvrc1")) {
    std::string name = entry.path().filename().string();
    name.resize(name.size() - std::string("-ch.txt").size());
    INFO(name);
    // The robot's authors supply these polyhedra for the same links. The support functions agree, so it is
    // right that up_axis is ignored.
    const std::vector<Vector3d> polyhedron = loadPoints(entry.path().string());
    const std::vector<Vector3d> mesh = loadPoints(robot + "/meshes/" + name + ".dae");
    const auto height = [](const std::vector<Vector3d>& points, const Vector3d& n) {
      double highest = points[0].dot(n);
      for (const Vector3d& p : points) highest = std::max(highest, p.dot(n));
      return highest;
    };
    Random random(1);
    for (int i = 0; i < 100; ++i) {
      const Vector3d n = random.direction();
      CHECK(std::abs(height(polyhedron, n) - height(mesh, n)) < 1e-5);
    }
  }
}
