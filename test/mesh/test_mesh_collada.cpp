// COLLADA files whose contents contradict each other are refused with the line; valid COLLADA is read.
#include <catch2/catch.hpp>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/mesh_file.h"
#include "test/reference/volume_files.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Catch::Matchers::Contains;

namespace {

// A triangle with texture coordinates, placed by a node of the library.
const std::string kSound = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#pa" count="3" stride="3"><param name="X"/><param name="Y"/><param name="Z"/></accessor>
</technique_common></source>
<source id="t"><float_array id="ta" count="6">0 0 1 0 0 1</float_array><technique_common>
<accessor source="#ta" count="3" stride="2"><param name="S"/><param name="T"/></accessor>
</technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/>
<input semantic="TEXCOORD" source="#t" offset="1" set="0"/>
<p>0 0 1 1 2 2</p></triangles>
</mesh></geometry></library_geometries>
<library_nodes><node id="m">
<instance_geometry url="#g"/></node></library_nodes>
<library_visual_scenes><visual_scene id="s"><node id="n">
<translate>0 0 1</translate>
<instance_node url="#m"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";

struct Change {
  std::string from, to;
};

struct Fault {
  std::string from, to, message;
};

std::string changed(std::string text, const Change& change) {
  const std::size_t at = text.find(change.from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, change.from.size(), change.to);
}

std::string loadedText(const std::string& text) {
  const TemporaryFolder folder;
  put(folder / "t.dae", text);
  std::size_t count = 3;
  const std::string message =
      refusal([&count](const std::string& path) { count = loadPoints(path).size(); }, folder / "t.dae");
  CHECK(count == 3);
  return message;
}

void checkRefused(const std::vector<Fault>& faults) {
  for (const Fault& fault : faults) {
    CAPTURE(fault.from, fault.to);
    CHECK_THAT(loadedText(changed(kSound, {fault.from, fault.to})), Contains(fault.message));
  }
}

}  // namespace

TEST_CASE("a COLLADA document without a mesh in its scene is no body") {
  checkRefused({{"<instance_geometry url=\"#g\"/>", "", "t.dae: holds no vertices"},
                {"<instance_node url=\"#m\"/>", "", "t.dae: holds no vertices"}});
}

TEST_CASE("a COLLADA reference that leads nowhere is refused") {
  const std::string shape = "<instance_geometry url=\"#g\"/>", node = "<instance_node url=\"#m\"/>";
  checkRefused({{"url=\"#g\"", "url=\"#h\"", "t.dae:17: <instance_geometry> names the geometry '#h'"},
                {shape, shape + "<instance_geometry url=\"other.dae#g\"/>", "t.dae:17: "},
                {node, node + "<instance_node url=\"#o\"/>", "t.dae:20: <instance_node> names the node '#o'"},
                {node, node + "<instance_node url=\"other.dae#m\"/>", "t.dae:20: "},
                {"source=\"#p\"", "source=\"#q\"", "t.dae:11: "},
                {"source=\"#ta\"", "source=\"#q\"", "t.dae:9: "},
                {"<geometry id=\"g\">", "<geometry id=\"g\"/><geometry id=\"g\">", "t.dae:4: "}});
}

TEST_CASE("COLLADA elements that assimp would pass over, and with them a shape or its place, are refused") {
  const std::string none = "> is no element of COLLADA within <";
  checkRefused(
      {{"<translate>0 0 1</translate>", "<translates>0 0 1</translates>",
        "t.dae:19: <translates" + none + "node>"},
       {"<node id=\"n\">", "<Node><instance_geometry url=\"#g\"/></Node><node id=\"n\">",
        "t.dae:18: <Node" + none + "visual_scene>"},
       {"<instance_geometry url=\"#g\"/>", "<instance_geometry url=\"#g\"/><instance_geometr url=\"#g\"/>",
        "t.dae:17: <instance_geometr" + none},
       {"<vertices id", "<Triangles/><vertices id", "t.dae:11: <Triangles" + none + "mesh>"},
       {"<mesh>", "<mesh/><Mesh/><mesh>", "t.dae:4: <Mesh" + none + "geometry>"},
       {"<library_geometries>", "<assets><unit meter=\"0.01\"/></assets><library_geometries>",
        "<assets" + none + "COLLADA>"},
       {"<library_geometries>", "<c:asset><unit meter=\"0.01\"/></c:asset><library_geometries>",
        "<c:asset" + none},
       {"<library_geometries>", "<asset><units meter=\"0.01\"/></asset><library_geometries>",
        "<units" + none + "asset>"},
       {"<node id=\"m\">", "<node id=\"m\"/><node id=\"m\">",
        "t.dae:16: <node> has an id that another one has"}});
}

TEST_CASE("a COLLADA skin or morph, whose vertices are elsewhere than the geometry's, is refused") {
  const std::string shape = "<instance_geometry url=\"#g\"/>", library = "<library_visual_scenes>";
  const std::string skin =
      "<library_controllers><controller id=\"c\"><skin source=\"#g\"><bind_shape_matrix>1 0 0 5 0 1 0 0 0 0 "
      "1 0 "
      "0 0 0 1</bind_shape_matrix></skin></controller></library_controllers>";
  const std::string unused = changed(kSound, {library, skin + library});
  CHECK(loadedText(unused) == "");
  CHECK_THAT(loadedText(changed(unused, {shape, "<instance_controller url=\"#c\"/>"})),
             Contains("t.dae:17: <instance_controller> has a skin or morph"));
}

TEST_CASE("a COLLADA array that is shorter than its accessor takes it to be is refused") {
  const std::string takes = "t.dae:6: <accessor> takes ", point = "t.dae:6: <accessor> must have a stride";
  checkRefused({{"\"#pa\" count=\"3\"", "\"#pa\" count=\"4\"", takes + "12 numbers from '#pa', which has 9"},
                {"count=\"9\">0 0 0", "count=\"8\">0 0", takes + "9"},
                {"stride=\"3\"", "stride=\"4\"", takes + "11"},
                {"stride=\"3\"", "stride=\"3\" offset=\"1\"", takes + "10"},
                {"\"#ta\" count=\"3\"", "\"#ta\" count=\"4\"", "t.dae:9: <accessor> takes 8"},
                {"stride=\"3\"", "stride=\"2\"", point},
                {"stride=\"3\"", "stride=\"0\"", point},
                {"stride=\"3\"", "", point},
                {"<param name=\"Z\"/>", "", point},
                {"<param name=\"Z\"/>", "<param name=\"z\"/>", point},
                {"<param name=\"Y\"/>", "<param name=\"S\"/>", point},
                {"stride=\"3\"", "stride=\"three\"", "t.dae:6: "},
                {"count=\"9\"", "count=\"10\"", "t.dae:5: <float_array> holds 9 numbers"},
                {"0 0 0 1 0 0 0 1 0<", "0 0 0 1 0 0 0 1 0 7<", "t.dae:5: <float_array> holds 10 numbers"}});
}

TEST_CASE("COLLADA numbers that are none, or that assimp takes for others, are refused") {
  const std::string index = "t.dae:14: got '-2' in <p>";
  checkRefused(
      {{"<p>0 0 1 1 2 2", "<p>0 0 1 1 -2 2", index},
       {"<p>0 0 1 1 2 2", "<p >0 0 1 1 -2 2", index},
       {"<p>0 0 1 1 2 2", "<p>0 0 1 1 4294967298 2", "t.dae:14: "},
       {"<p>0 0 1 1 2 2", "<p>0 0 1 <!-- c --> 1 2 2", "t.dae:14: "},
       {"<triangles count=\"1\">", "<triangles count=\"0\">", "t.dae:12: "},
       {"source=\"#p\"/>", "source=\"#p\"/><input semantic=\"POSITION\" source=\"#p\"/>", "t.dae:12: "},
       {"offset=\"0\"", "offset=\"none\"", "t.dae:12: "},
       {"semantic=\"VERTEX\"", "semantic=\"NONE\"", "t.dae:12: "},
       {">0 0 0 1 0 0", ">\n0 0 0\n1e999 0 0", "t.dae:7: got '1e999' in <float_array>"},
       {">0 0 0 1 0 0", ">0 0 0 100000000000000000000 0 0", "t.dae:5: "},
       {"<translate>0 0 1", "<translate>0 0 100000000000000000000", "t.dae:19: "},
       {"<translate>0 0 1", "<translate>0 0,5 1", "t.dae:19: "},
       {"<translate>0 0 1", "<translate>0 0 1 1", "t.dae:19: "},
       {"<translate>0 0 1", "<skew>45 0 1 0 1 0 0</skew><translate>0 0 1", "t.dae:19: "},
       {"<mesh>", "<asset><unit meter=\"0.001\"/></asset><mesh>", "t.dae:4: <unit>"},
       {"<unit meter=\"1\"", "<unit metre=\"0.001\"", "t.dae:3: <unit> has an attribute 'metre'"},
       {"<unit meter=\"1\"", "<Unit meter=\"0.001\"", "t.dae:3: <Unit> is no element"},
       {"</COLLADA>", "</COLLADA><COLLADA/>", "t.dae:21: not XML"},
       {"</COLLADA>", "</collada>", "t.dae:2: not XML"}});
}

TEST_CASE("a COLLADA transform that would distort the body is refused") {
  const std::string from = "<translate>0 0 1</translate>", axis = "t.dae:19: <rotate> has an axis of length ";
  const auto rotate = [&](const std::string& numbers, const std::string& length) {
    return Fault{from, "<rotate>" + numbers + "</rotate>", axis + length};
  };
  const auto view = [&](const std::string& numbers) {
    return Fault{from, "<lookat>" + numbers + "</lookat>", "t.dae:19: <lookat> must have a point to look at"};
  };
  const auto matrix = [&](const std::string& numbers) {
    return Fault{from, "<matrix>" + numbers + "</matrix>", "t.dae:19: <matrix> must have 0 0 0 1"};
  };
  checkRefused({matrix("1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1"), matrix("1 0 0 0 0 1 0 0 0 0 1 1 0 0 0 2")});
  checkRefused({rotate("1 1 0 60", "1.414214"), rotate("0.577 0.577 0.577 60", "0.999393"),
                rotate("0.7071 0.7071 0 60", "0.999990"), rotate("0 0 0 90", "0.000000"),
                rotate("0 0 -2 180", "2.000000"), view("0 0 0 0 0 -1 0 0 1"), view("0 0 0 0 0 0 0 1 0"),
                view("1 2 3 1 2 3 0 1 0"), view("0 0 0 0 0 -1 0 0 0"), view("0 0 0 0 0 -1 0 1 0.1")});
}

TEST_CASE("a COLLADA mesh that its transforms bring back from far away is refused") {
  const std::string away = "<translate>0 0 1</translate>", node = "<node id=\"m\">";
  const std::string message = "is too far from its origin";
  checkRefused(
      {{away, "<translate>0 0 1e5</translate><translate>0 0 -1e5</translate>", message},
       {away, "<translate>1e6 0 0</translate><rotate>0 0 1 90</rotate><translate>-1e6 0 0</translate>",
        message},
       {away, "<matrix>1 0 0 1e5 0 1 0 0 0 0 1 0 0 0 0 1</matrix><translate>-1e5 0 0</translate>", message},
       {away,
        "<scale>1e4 1 1</scale><translate>10 0 0</translate><translate>-10 0 0</translate><scale>1e-4 1 "
        "1</scale>",
        message},
       {"0 0 0 1 0 0 0 1 0", "1e5 0 0 100001 0 0 1e5 1 0", message}});
  std::string scaled =
      changed(kSound, {node, node + "<translate>2e3 0 0</translate><translate>-2e3 0 0</translate>"});
  scaled = changed(changed(scaled, {"0 0 0 1 0 0 0 1 0", "0 0 0 .001 0 0 0 .001 0"}),
                   {away, "<scale>1000 1000 1000</scale>"});
  CHECK_THAT(loadedText(scaled), Contains(message));
  const std::string library = "<library_nodes>";
  CHECK(
      loadedText(changed(
          kSound, {library, library + "<node id=\"unused\"><translate>1e6 0 0</translate><translate>-1e6 0 0"
                                      "</translate><instance_geometry url=\"#g\"/></node>"})) == "");
  std::string text = changed(kSound, {away, "<translate>-1e5 0 0</translate>"});
  text = changed(text, {"0 0 0 1 0 0 0 1 0", "1e5 0 0 100001 0 0 1e5 1 0"});
  const TemporaryFolder folder;
  put(folder / "t.dae", text);
  CHECK_THAT(refusal([](const std::string& path) { loadPoints(path); }, folder / "t.dae"), Contains(message));
  // A camera may be at any place.
  put(folder / "t.dae", changed(kSound, {node,
                                         "<node id=\"c\"><translate>1e6 0 0</translate><translate>-1e6 0 "
                                         "0</translate><instance_camera url=\"#c\"/></node>" +
                                             node}));
  CHECK(refusal([](const std::string& path) { loadPoints(path); }, folder / "t.dae") == "");
}

TEST_CASE(
    "COLLADA lines and strips that are not whole, and geometries of which a part is not read, are refused") {
  const std::string triangles = "<triangles count=\"1\">", close = "<p>0 0 1 1 2 2</p></triangles>";
  const auto as = [&](const std::string& kind, const std::string& runs) {
    const std::size_t begin = kSound.find(triangles), end = kSound.find(close);
    return kSound.substr(0, begin) + "<" + kind + " count=\"1\">" +
           kSound.substr(begin + triangles.size(), end - begin - triangles.size()) + runs + "</" + kind +
           ">" + kSound.substr(end + close.size());
  };
  CHECK_THAT(loadedText(as("lines", "<p>0 0 1 1 2 2</p>")), Contains("which make no whole <lines>"));
  const std::string run = "<p>0 0 1 1 2 2</p>";
  CHECK_THAT(loadedText(as("polygons", run + run)), Contains("holds 2 <p>, but its count is 1"));
  CHECK(loadedText(as("polygons", run)) == "");
  CHECK_THAT(loadedText(as("linestrips", "<p>0 0 1 1 2 2</p><p>0 0</p>")), Contains("no whole <linestrips>"));
  CHECK_THAT(loadedText(as("tristrips", "<p>0 0 1 1</p>")), Contains("no whole <tristrips>"));
  CHECK_THAT(loadedText(as("trifans", "<p>0 0 1 1 2</p>")), Contains("no whole <trifans>"));
  CHECK(loadedText(as("linestrips", "<p>0 0 1 1 2 2</p>")) == "");
  CHECK(loadedText(as("tristrips", "<p>0 0 1 1 2 2</p>")) == "");
  checkRefused({{"</mesh>", "</mesh><mesh/>", "<mesh> is the second one of its <geometry>"},
                {"<accessor source=\"#pa\" count=\"3\"", "<accessor source=\"#pa\" ofset=\"1\" count=\"3\"",
                 "<accessor> has an attribute 'ofset'"}});
  const std::string shape = "<instance_geometry url=\"#g\"/>", last = "</library_geometries>";
  for (const std::string geometry : {"<geometry id=\"e\"/>", "<geometry id=\"e\"><spline/></geometry>"})
    CHECK_THAT(loadedText(changed(changed(kSound, {last, geometry + last}),
                                  {shape, shape + "<instance_geometry url=\"#e\"/>"})),
               Contains("<mesh>"));
}

TEST_CASE("sound COLLADA is read, whatever its writer's habits") {
  const Change wide{"stride=\"3\"", "stride=\"4\""};
  const Change reordered{"<param name=\"X\"/><param name=\"Y\"/>", "<param name=\"Y\"/><param name=\"X\"/>"};
  for (const std::vector<Change>& changes : std::vector<std::vector<Change>>{
           {},
           {reordered},
           {wide, {"count=\"9\">0 0 0 1 0 0 0 1 0", "count=\"11\">0 0 0 7 1 0 0 7 0 1 0"}},
           {wide,
            {"<param", "<param/><param"},
            {"\"9\">0 0 0 1 0 0 0 1 0", "\"12\">7 0 0 0 7 1 0 0 7 0 1 0"}},
           {{"stride=\"3\"", "stride=\"3\" offset=\"1\""}, {"count=\"9\">", "count=\"10\">7 "}},
           {{"<p>0 0 1 1 2 2", "<p >\n0 0\n1 1\n2 2\n"}},
           {{"<translate>0 0 1</translate>",
             "<rotate>.577350 .577350 .577350 60</rotate><rotate>0 0 0 0</rotate>"}},
           {{"<translate>0 0 1</translate>", "<matrix>1 0 0 0 0 1 0 0 0 0 1 1 0 0 0 1</matrix>"}},
           {{"<translate>0 0 1</translate>", "<lookat>1 2 3 1 2 -2 0 3 0</lookat>"}},
           {{"<mesh>", "<!-- <unit meter=\"0\"/> --><asset><unit meter=\"1.0\"/></asset><mesh>"}},
           {{"<node id=\"m\">", "<node name=\"m\"><translate>1e0 +2 .5</translate>"},
            {"<library_nodes>", "<library_visual_scenes><visual_scene id=\"other\">"},
            {"</library_nodes>", "</visual_scene></library_visual_scenes>"},
            {"<instance_node url=\"#m\"/>", "<instance_geometry url=\"#g\"/>"}}}) {
    std::string text = kSound;
    for (const Change& change : changes) text = changed(text, change);
    CAPTURE(text);
    CHECK(loadedText(text) == "");
  }
}
