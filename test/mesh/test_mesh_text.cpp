// OBJ, STL, OFF and PLY as text: what assimp would ignore or misread is refused with the line; what it reads
// correctly is read.
#include <catch2/catch.hpp>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/mesh_file.h"
#include "test/reference/volume_files.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Catch::Matchers::Contains;

namespace {

struct Mesh {
  std::string text, place;
};

void checkRefused(const std::string& file, const std::vector<Mesh>& meshes) {
  const TemporaryFolder folder;
  for (const Mesh& mesh : meshes) {
    CAPTURE(mesh.text);
    put(folder / file, mesh.text);
    CHECK_THAT(refusal([](const std::string& path) { loadPoints(path); }, folder / file),
               Contains(file + mesh.place));
  }
}

void checkRead(const std::string& file, const std::vector<std::string>& texts, std::size_t triangles = 1) {
  const TemporaryFolder folder;
  for (const std::string& text : texts) {
    CAPTURE(text);
    put(folder / file, text);
    TriangleMesh mesh;
    CHECK(refusal([&mesh](const std::string& path) { mesh = loadMesh(path); }, folder / file) == "");
    CHECK(mesh.vertices.size() == 3);
    CHECK(mesh.triangles.size() == triangles);
  }
}

const std::string kBig = "100000000000000000000 0 0\n";

}  // namespace

TEST_CASE("OBJ: comments, joined lines and numbers that assimp takes for others") {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n", face = "f 1 2 3\n";
  checkRefused("t.obj", {{obj + "v " + kBig, ":4: "},
                         {obj + "v .5 0 0\n", ":4: "},
                         {obj + "v 0.0000000000000000009e18 0 0\n", ":4: "},
                         {obj + "v 0 -0.0000001000000009E+07 0\n", ":4: "},
                         {obj + "v 0 0 0 1 1\n", ":4: a vertex of 5 numbers"},
                         {obj + "v 0 0 0 2\n", ":4: a vertex has the weight 2,"},
                         {obj + "v 0 0 0 0\n", ":4: a vertex has the weight 0,"},
                         {obj + "v 0 0 0 1 1 1 1\n", ":4: a vertex of 7 numbers"},
                         {obj + "V 0 0 1\n", ":4: "},
                         {obj + " v 0 0 1\n", ":4: "},
                         {obj + "\tf 1 2 3\n", ":4: "},
                         {obj + "v 0 0 1 # 4\n", ":4: a number in the comment"},
                         {obj + "v 0 0 1 # 4 5\n", ":4: a number in the comment"},
                         {obj + "f 1 2 3 # a face\n", ":4: a comment after vertices"},
                         {obj + "l 1 2 # a line\n", ":4: a comment after vertices"},
                         {obj + "# C:\\\nv 0 0 1\n", ":4: a line that ends in a backslash"},
                         {obj + "# C:\\\n\nv 0 0 1\n", ":4: a line that ends in a backslash"},
                         {obj + "g a\\\nf 1 2 3\n", ":4: a line that ends in a backslash"},
                         {obj + "# C:\\\rv 0 0 1\r", ":4: a line that ends in a backslash"},
                         {obj + "f 1 2 \\\n", ":4: "}});
  checkRead("t.obj",
            {"v 0 0 0 # a\nv 1 0 0 #1\nv 0 1 0#b\n" + face,
             "# C:\\\n# a file\n" + obj + "# goes \\\non\n" + face + "# C:\\\n", obj + "f 1 \\\n2 3\n",
             obj + "f 1 2\\\r\n 3\r\n", "# C:\\ \n" + obj + face,
             "v 0 0 0 1\nv 1 0 0 1 1 1\nv 0 1e0 0\n" + face, "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r"});
}

TEST_CASE("numbers as printf and numpy write them in full are read") {
  checkRead(
      "t.obj",
      {"v 0.0000000000000000e+00 0.000000000000000000e+00 0\n"
       "v 1.0000000000000000e+00 0 0.10000000000000000555e+00\nv 0 1.234567890123456700E+02 0\nf 1 2 3\n"});
}

TEST_CASE("OBJ: statements that assimp would pass over") {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n", face = "f 1 2 3\n";
  const std::string unknown = ", which is no statement of OBJ";
  checkRefused("t.obj",
               {{"v 0 0 0\nvv 1 0 0\nv 0 1 0\nv 9 9 9\n" + face, ":2: a line begins with 'vv'" + unknown},
                {"v 0 0 0\n1 0 0\nv 0 1 0\nv 9 9 9\n" + face, ":2: a line begins with '1'" + unknown},
                {obj + "face 1 2 3\n", ":4: a line begins with 'face'"},
                {obj + face + "cstype bezier\nsurf 0 1 0 1 1 2 3 3\n", ":6: 'surf' is not read"},
                {obj + face + "call other.obj\n", ":5: 'call' is not read"}});
  checkRead("t.obj", {"mtllib a.mtl\no a\ng b c\ns off\nmg 0\nusemtl d\n#e\n\n" + obj + face + "bevel on\n"});
}

TEST_CASE("OBJ: faces that assimp would drop over their texture coordinates") {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n", face = "f 1/1/1 2/1/1 3/1/1\n";
  const std::string vt = "vt 0 0\n", vn = "vn 0 0 1\n", unknown = "'1/1/1' names a texture coordinate";
  checkRefused("t.obj",
               {{obj + vn + face, ":5: " + unknown},
                {obj + vn + face + vt, ":5: " + unknown},
                {obj + " " + vt + vn + face, ":6: " + unknown},
                {obj + vn + "f -3/-1/-1 -2/-1/-1 -1/-1/-1\n", ":5: '-3/-1/-1' names"},
                {obj + vn + "l 1/1/1 2/1/1\n", ":5: " + unknown},
                {obj + "f 1/1/1/1 2/1/1/1 3/1/1/1\n", ":4: a vertex of a face has more than two slashes"},
                {obj + vt + vn + "f 1/1/1/1 2/1/1/1 3/1/1/1\n", ":6: "}});
  checkRead("t.obj", {obj + face, obj + vt + face, obj + vt + vn + face, vn + vt + obj + face,
                      obj + vn + "f 1//1 2//1 3//1\n", obj + vn + "f 1/1 2/1 3/1\n", obj + vn + "f 1 2 3\n",
                      obj + vt + vn + "f 1/9/9 2/9/9 3/9/9\n", obj + "f 1/1/1 2/1/1 3/1/1\n" + vn + vt});
}

TEST_CASE("OBJ: a number longer than assimp's buffer") {
  const std::string rest = " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  checkRefused("t.obj", {{"v 0." + std::string(4093, '0') + rest, ":1: a number of 4095 characters"},
                         {"v 0 0." + std::string(5000, '0') + " 0\n", ":1: a number of 4095 characters"}});
  checkRead("t.obj", {"# " + std::string(5000, 'c') + "\nv 0." + std::string(4092, '0') + rest});
}

TEST_CASE("a NUL byte in a text is refused, wherever it stands") {
  const std::string nul(1, '\0'), obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  checkRefused("t.stl", {{"solid a\n" + facet + nul + facet + "endsolid a\n", ":9: a NUL byte"},
                         {"solid a" + nul + "\n" + facet + "endsolid a\n", ":1: a NUL byte"}});
  checkRefused("t.obj", {{obj + "#" + nul + "\n", ":5: a NUL byte"}, {obj + nul, ":5: a NUL byte"}});
  checkRefused("t.off", {{"OFF\n3 1 3\n0 0 0\n1 0 0\n0 1 0 #" + nul + "\n3 0 1 2\n", ":5: a NUL byte"}});
  checkRefused("t.gltf", {{"{\"asset\":{\"version\":\"2.0\"}}\n" + nul, ":2: a NUL byte"}});
  checkRefused("t.ply",
               {{"ply\nformat ascii 1.0\ncomment " + nul +
                     "\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement "
                     "face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 "
                     "0 1 2\n",
                 ":3: a NUL byte"}});
}

TEST_CASE("a byte-order mark that hides a line is refused, one before a comment is not") {
  const std::string mark = "\xEF\xBB\xBF", obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  checkRefused("t.obj", {{mark + obj, ":1: begins with a byte-order mark"}});
  checkRefused("t.off",
               {{mark + "OFF\n3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", ":1: begins with a byte-order mark"}});
  const TemporaryFolder folder;
  put(folder / "t.obj", mark + "# by hand\n" + obj);
  CHECK(loadPoints(folder / "t.obj").size() == 3);
}

TEST_CASE("STL: each facet is in a solid and each vertex in a facet") {
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  const std::string solid = "solid a\n" + facet + "endsolid a\n", vertices = "vertex 0 0 1\nvertex 1 0 1\n";
  checkRefused("t.stl", {{solid + facet + "endsolid a\n", ":10: "},
                         {solid + "by hand\n" + solid, ":10: "},
                         {"solid a endsolid\n" + facet, ":2: "},
                         {"solid a\n" + facet + "outer endsolid\n" + facet, ":10: "},
                         {"solid a\n" + facet + vertices + "vertex 0 1 1\nendsolid a\n", ":9: "},
                         {"solid a\nfacet normal 0 0 1\nendsolid a\n", ":3: "},
                         {"solid a\nfacet normal 0 0 1\nouter loop vertex 7 7 7\n", ":3: "},
                         {"solid a\nfacet normal 0 0 1\nvertex 0 0 0 1\n", ":3: "},
                         {"solid a\nfacet normal 0 0 1\nvertex " + kBig, ":3: "},
                         {"solid a\n" + facet + "FACET normal 0 0 1\n", ":9: "},
                         {solid + "SOLID b\n" + facet + "endsolid b\n", ":10: 'SOLID' is not read"},
                         {solid + "Solid b\n" + facet + "endsolid b\n", ":10: "},
                         {"solid a\n" + facet + "EndSolid a\n" + solid, ":9: "},
                         {"solid a\n" + facet, ":8: ends within a solid"},
                         {"solid a\n" + facet + "fac", ":9: got 'fac'"},
                         {"solid a\n\u200B" + facet + "endsolid a\n", ":2: got"},
                         {"solid a\n" + facet + "endfacet\nendsolid a\n", ":9: 'endfacet' outside"},
                         {" solid a\nfacet normal 0 0 1\nvertex 0,5 0 0\n", ":3: "}});
  checkRead("t.stl",
            {"solid a\nendsolid a\n\n  " + solid, solid + "\nby hand\n", "solid\n" + facet + "endsolid\n"});
  checkRead("t.stl", {solid + "solid b\n" + facet + "endsolid b facet\n"}, 2);
}

TEST_CASE("OFF: as many lines as the header says, and indices below its number of vertices") {
  const std::string off = "OFF\n3 1 3\n0 0 0\n1 0 0\n", last = "0 1 0\n", face = "3 0 1 2\n";
  checkRefused("t.off", {{off + last + "3 0 1 3\n", ":6: "},
                         {off + last + "3 0 1 -1\n", ":6: "},
                         {off + last + "3 0 1\n", ":6: "},
                         {off + last + "0 0 1\n" + face, ":6: "},
                         {off + last + face + face, ":7: "},
                         {off + last, ":5: ends after 0 of the 1 faces"},
                         {off, ":4: ends after 2 of the 3 vertices"},
                         {off + kBig + face, ":5: "},
                         {off + "0 nan 0\n" + face, ":5: "},
                         {off + "0 1 4 0\n" + face, ":5: "},
                         {off + "3 0 4 2\n" + face, ":5: "},
                         {off + "0 +-1 0\n" + face, ":5: "},
                         {off + "# the third\n" + last + face, ":5: a comment or blanks"},
                         {off + last + " \n" + face, ":6: a comment or blanks"},
                         {off + last + "10 0 1 2 0 1 2 0 1 2 0\n", ":6: a face of 10 vertices"},
                         {"COFF 3 1 0\n0 0 0 1 0 0\n", ":2: "},
                         {"NOFF 3 1 0\n0 0 0 1 0\n", ":2: "},
                         {"4 1 0\n", ":1: an OFF file must begin"},
                         {"OFF\n3 one 0\n", ":2: got 'one'"}});
  checkRead("t.off",
            {off + last + face, "OFF\n3 1 3\n0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 0\n" + face,
             "OFF\n3 1 3\n0 0 0.00000000000000000001\n1 0 0\n0 1.00000000000000000001e-0 0\n" + face,
             "OFF # a\n\n# b\n3 1 0 # c\n\n 0 0 0 # d\n\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n\n # e\n",
             "OFF 3 1 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n", "3 1 0 0 0 0\n1 0 0\n0 1 0\n3 0 1 2",
             "COFF 3 1 0\n0 0 0 1 0 0 1\n1 0 0 1 0 0 1\n0 1 0 1 0 0 1\n3 0 1 2\n",
             "4nOFF\n2\n3 1 0\n0 0 1\n1 0 1\n0 1 2\n3 0 1 2\n"});
}

TEST_CASE("PLY as text: an element a line, and the properties that make a mesh") {
  const auto ply = [](const std::string& properties, const std::string& body) {
    return "ply\nformat ascii 1.0\nelement vertex 3\n" + properties +
           "element face 1\nproperty list uchar int vertex_indices\nend_header\n" + body;
  };
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n", face = "3 0 1 2\n";
  checkRefused(
      "t.ply",
      {{ply(xyz, kBig + "1 0 0\n0 1 0\n" + face), ":10: "},
       {ply(xyz, "0 0 0 1 0 0\n0 1 0\n" + face), ":10: the line holds more than one"},
       {ply(xyz, "0 0\n0\n1 0 0\n0 1 0\n" + face), ":10: the line holds less than one"},
       {ply(xyz, "0 0 0\n\n\n1 0 0\n0 1 0\n" + face), ":12: the line holds less than one"},
       {ply(xyz, vertices), ":12: ends within its elements 'face'"},
       {ply(xyz, vertices + "3 0 1 4294967298\n"), ":13: "},
       {ply(xyz, vertices + face + "\n" + face), ":15: holds more than the elements"},
       {ply(xyz, vertices + "3 0 1 2.0\n"), ":13: "},
       {ply("property int x\nproperty float y\nproperty float z\n", "1.5 0 0\n"), ":10: "},
       {ply("property int x\nproperty uchar y\nproperty int z\n", "1 -2 3\n"),
        ":10: got '-2' for a value of the element 'vertex', expected a whole number from 0 to 255"},
       {ply("property int x\nproperty int y\nproperty int z\n", "1 2 2147483648\n"), ":10: got '2147483648'"},
       {ply("property short x\nproperty short y\nproperty short z\n", "1 2 -32769\n"), ":10: got '-32769'"},
       {ply("property float x\nproperty float y\n", ""), ": the element 'vertex' has no property 'z'"},
       {ply("", ""), ": the element 'vertex' has no properties"},
       {ply("property float x\ncomment a\nproperty float y\nproperty float z\n", ""), ":6: "},
       {ply("comment a\n" + xyz, ""), ":5: "},
       {ply("\n" + xyz, ""), ":4: "},
       {"ply\nformat ascii 1.0\nelement vertex 3\n" + xyz +
            "element face 1\nproperty list uchar int vertices\nend_header\n",
        ": the element 'face' has no list 'vertex_indices'"},
       {ply(xyz + "property float x\n", "0 0 0 5\n1 0 0 5\n0 1 0 5\n" + face),
        ": the element 'vertex' has more than one property 'x'"},
       {ply(xyz + "element vertex 3\n" + xyz, vertices + vertices + face), ": has two elements 'vertex'"},
       {ply(xyz + "element tristrips 1\nproperty list int int vertex_indices\n",
            vertices + "4 0 1 2 0\n" + face),
        ": the element 'tristrips' is not read whole"}});
  checkRead("t.ply", {ply(xyz, vertices + face), ply(xyz + "comment a\n", "0 0 0\n\n1 0 0\n0 1 0\n\n" + face),
                      ply("property char x\nproperty uint y\nproperty short z\n",
                          "-128 0 0\n127 4294967295 0\n0 1 -32768\n" + face),
                      ply("property uchar red\n" + xyz, "1 0 0 0\n255 1 0 0\n0 0 1 0\n" + face)});
}

TEST_CASE("a mesh is checked in the format in which assimp reads it, for any ending of its name") {
  const std::string stl =
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n";
  for (const char* file : {"t.glb", "t.gltf", "t.xml"}) {
    checkRefused(file, {{stl + "vertex 0 0 1\nendloop\nendfacet\nendsolid a\n", ":9: a facet has 4 vertices"},
                        {"# a mesh\nv 0 0 0\nv 1 0 0 7 7\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", ":3: "},
                        {"OFF\n3 1 3\n0 0 0\n1,5 0 0\n0 1 0\n3 0 1 2\n", ":4: "}});
    checkRead(file, {stl + "endloop\nendfacet\nendsolid a\n"});
  }
}

TEST_CASE("a mesh without a known ending is checked in the format in which assimp reads it") {
  const std::string stl =
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1,5 0 0\nvertex 0 1 0\n";
  for (const char* file : {"t", "t.bak"}) {
    checkRefused(file, {{stl + "endloop\nendfacet\nendsolid a\n", ":5: "}});
    checkRefused(file, {{"# a mesh\nv 0 0 0\nv 1 0 0 7 7\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", ":3: "}});
  }
}

TEST_CASE("vertices that no element uses count in OFF and PLY, not in OBJ") {
  const auto points = [](const std::string& text) { return parseMesh(text, "-").vertices.size(); };
  const std::string
      vertices = "0 0 0\n1 0 0\n0 1 0\n5 5 5\n",
      ply =
          "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
          "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  CHECK(points("OFF\n4 1 3\n" + vertices + "3 0 1 2\n") == 4);
  CHECK(points(ply + vertices + "3 0 1 2\n") == 4);
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nf 1 2 3\n";
  CHECK(points(obj) == 3);
  CHECK(points(obj + "p 4\n") == 4);
  CHECK(points(obj + "l 1 4\n") == 4);
}
