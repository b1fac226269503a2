// Checks the sources of COLLADA's geometries and the indices into them, in the order in which assimp reads
// them, because an id refers to the last element with this id before its use.
#include "fcl_stpbv/mesh/collada_arrays.h"

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "fcl_stpbv/mesh/collada_values.h"
#include "fcl_stpbv/words.h"

namespace fcl_stpbv::detail {
namespace {

using tinyxml2::XMLElement;

// The uses of a source that assimp knows. It ignores other uses.
constexpr Words kSemantics{"POSITION", "NORMAL",     "TEXCOORD", "COLOR",
                           "TANGENT",  "TEXTANGENT", "BINORMAL", "TEXBINORMAL"};
constexpr Words kPrimitives{"triangles", "lines",   "linestrips", "polygons",
                            "polylist",  "trifans", "tristrips"};

// If an attribute is misspelt, assimp reads the table from a wrong place.
constexpr Words kOfAccessor{"count", "offset", "source", "stride"};

struct Accessor {
  const XMLElement* element = nullptr;
  std::string array;
  std::size_t count = 0, offset = 0, stride = 1;
  std::size_t width = 1;  // number of values from the first to the last one of an item
  bool hasPoint = false;  // whether there are values for x, y and z
};

std::string idOf(const XMLElement& element) {
  const char* id = element.Attribute("id");
  return id == nullptr ? "" : id;
}

std::vector<const XMLElement*> allBelow(const XMLElement& top) {
  std::vector<const XMLElement*> all;
  for (const XMLElement* e = top.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    all.push_back(e);
    const std::vector<const XMLElement*> below = allBelow(*e);
    all.insert(all.end(), below.begin(), below.end());
  }
  return all;
}

class ColladaArrays {
 public:
  explicit ColladaArrays(const std::string& name) : name_(name) {}

  void checkMesh(const XMLElement& mesh) {
    std::vector<const XMLElement*> vertexInputs;
    for (const XMLElement* element : allBelow(mesh)) {
      const std::string_view kind = element->Name();
      if (kind == "source") {
        readSource(*element);
      } else if (kind == "vertices") {
        for (const XMLElement* e = element->FirstChildElement("input"); e; e = e->NextSiblingElement("input"))
          vertexInputs.push_back(e);
      } else if (holds(kPrimitives, kind)) {
        checkPrimitives(*element, vertexInputs);
      }
    }
  }

 private:
  void readSource(const XMLElement& source) {
    for (const XMLElement* element : allBelow(source)) {
      const std::string_view kind = element->Name();
      if (kind == "float_array") arrays_[idOf(*element)] = element;
      if (kind != "technique_common") continue;
      if (const XMLElement* accessor = element->FirstChildElement("accessor"))
        accessors_[idOf(source)] = readAccessor(*accessor);
    }
  }

  Accessor readAccessor(const XMLElement& element) {
    checkColladaAttributes(element, kOfAccessor, name_);
    Accessor accessor;
    accessor.element = &element;
    accessor.array = colladaTarget(element, "source", name_);
    accessor.count = colladaWhole(element, "count", 0, name_);
    accessor.offset = colladaWhole(element, "offset", 0, name_);
    accessor.stride = colladaWhole(element, "stride", 1, name_);
    // assimp recognises coordinates, colours and texture coordinates by these names. It takes the first value
    // for parameters without a name.
    static const std::map<std::string_view, std::size_t> kParts{{"X", 0}, {"R", 0}, {"S", 0}, {"U", 0},
                                                                {"Y", 1}, {"G", 1}, {"T", 1}, {"V", 1},
                                                                {"Z", 2}, {"B", 2}, {"P", 2}, {"A", 3}};
    std::size_t places[4] = {0, 0, 0, 0}, parameters = 0;
    std::string_view names[4];
    for (const XMLElement* param : allBelow(element)) {
      if (std::string_view(param->Name()) != "param") continue;
      const char* name = param->Attribute("name");
      const auto part = name == nullptr ? kParts.end() : kParts.find(name);
      if (part != kParts.end()) {
        places[part->second] = parameters;
        names[part->second] = part->first;
      }
      ++parameters;
    }
    accessor.width = 1 + *std::max_element(places, places + 4);
    accessor.hasPoint =
        names[0] == "X" && names[1] == "Y" && names[2] == "Z" && parameters <= accessor.stride;
    return accessor;
  }

  void checkPrimitives(const XMLElement& primitives, const std::vector<const XMLElement*>& vertexInputs) {
    std::vector<const XMLElement*> inputs;
    std::vector<std::pair<const XMLElement*, std::size_t>> runs;  // lists of indices
    std::size_t indices = 0, counts = 0;
    for (const XMLElement* element : allBelow(primitives)) {
      const std::string_view kind = element->Name();
      if (kind == "input") inputs.push_back(element);
      if (kind == "p") {
        runs.emplace_back(element, countIndices(*element, name_));
        indices += runs.back().second;
      }
      if (kind == "vcount") counts += countIndices(*element, name_);
    }
    if (indices == 0) return;
    const std::string_view kind = primitives.Name();
    const std::size_t count = colladaWhole(primitives, "count", 0, name_);
    if (count == 0) refuseCollada(primitives, "holds indices, but its count is 0", name_);
    if (kind == "polygons" && runs.size() != count)
      refuseCollada(
          primitives,
          "holds " + std::to_string(runs.size()) + " <p>, but its count is " + std::to_string(count), name_);
    if (counts == 0 && kind == "polylist")
      refuseCollada(primitives, "holds indices, but no <vcount> says of how many each polygon is made",
                    name_);
    checkRuns(primitives, inputs, runs);
    const auto has = [](const char* semantic) {
      return
          [semantic](const XMLElement* input) { return input->Attribute("semantic", semantic) != nullptr; };
    };
    if (std::none_of(inputs.begin(), inputs.end(), has("VERTEX")))
      refuseCollada(primitives, "holds indices, but no <input> with the semantic VERTEX", name_);
    inputs.insert(inputs.end(), vertexInputs.begin(), vertexInputs.end());
    if (std::count_if(inputs.begin(), inputs.end(), has("POSITION")) != 1)
      refuseCollada(primitives, "must have one <input> with the semantic POSITION, by way of its <vertices>",
                    name_);
    for (const XMLElement* input : inputs) checkInput(*input);
  }

  // assimp leaves out vertices of incomplete lines and strips.
  void checkRuns(const XMLElement& primitives, const std::vector<const XMLElement*>& inputs,
                 const std::vector<std::pair<const XMLElement*, std::size_t>>& runs) const {
    const std::string_view kind = primitives.Name();
    const bool lines = kind == "lines", lineStrips = kind == "linestrips";
    if (!lines && !lineStrips && kind != "tristrips" && kind != "trifans") return;
    std::size_t each = 1;  // number of indices per vertex
    for (const XMLElement* input : inputs)
      each = std::max(each, 1 + colladaWhole(*input, "offset", 0, name_));
    const std::size_t least = lines || lineStrips ? 2 : 3;
    for (const auto& [run, count] : runs) {
      const std::size_t vertices = count / each;
      const bool whole =
          lines ? vertices == 2 * colladaWhole(primitives, "count", 0, name_) : vertices >= least;
      if (count % each != 0 || !whole)
        refuseCollada(*run,
                      "holds " + std::to_string(count) + " indices, " + std::to_string(each) +
                          " for a vertex, which make no whole <" + std::string(kind) + ">",
                      name_);
    }
  }

  void checkInput(const XMLElement& input) {
    colladaWhole(input, "offset", 0, name_);
    const char* semantic = input.Attribute("semantic");
    if (semantic == nullptr || !holds(kSemantics, semantic)) return;
    const std::string source = colladaTarget(input, "source", name_);
    const auto found = accessors_.find(source);
    if (found == accessors_.end())
      refuseCollada(input, "names the source '#" + source + "', which does not exist before it", name_);
    const Accessor& accessor = found->second;
    const bool positions = std::string_view(semantic) == "POSITION";
    if (checked_.insert({accessor.element, positions}).second) checkAccessor(accessor, positions);
  }

  void checkAccessor(const Accessor& accessor, bool positions) {
    const auto found = arrays_.find(accessor.array);
    if (found == arrays_.end())
      refuseCollada(*accessor.element,
                    "names the <float_array> '#" + accessor.array + "', which does not exist before it",
                    name_);
    const XMLElement& array = *found->second;
    const std::size_t held = colladaWhole(array, "count", 0, name_);
    const std::size_t last =
        accessor.count == 0 ? 0 : accessor.offset + (accessor.count - 1) * accessor.stride + accessor.width;
    if (last > held)
      refuseCollada(*accessor.element,
                    "takes " + std::to_string(last) + " numbers from '#" + accessor.array + "', which has " +
                        std::to_string(held),
                    name_);
    if (!positions) return;
    if (!accessor.hasPoint)
      refuseCollada(*accessor.element,
                    "must have a stride of at least 3 and parameters named X, Y and Z, as positions have",
                    name_);
    const std::size_t words = countNumbers(array, name_);
    if (words != held)
      refuseCollada(array,
                    "holds " + std::to_string(words) + " numbers, but its count is " + std::to_string(held),
                    name_);
  }

  const std::string& name_;
  std::map<std::string, const XMLElement*> arrays_;
  std::map<std::string, Accessor> accessors_;
  std::set<std::pair<const XMLElement*, bool>> checked_;
};

}  // namespace

void checkColladaGeometries(const XMLElement& root, const std::string& name) {
  ColladaArrays arrays(name);
  for (const XMLElement* library = root.FirstChildElement("library_geometries"); library != nullptr;
       library = library->NextSiblingElement("library_geometries"))
    for (const XMLElement* geometry = library->FirstChildElement("geometry"); geometry != nullptr;
         geometry = geometry->NextSiblingElement("geometry"))
      for (const XMLElement* mesh = geometry->FirstChildElement("mesh"); mesh != nullptr;
           mesh = mesh->NextSiblingElement("mesh"))
        arrays.checkMesh(*mesh);
}

}  // namespace fcl_stpbv::detail
