// Damages one element or attribute of an XML text after another, each in a copy of the parsed document.
#include "test/robot/xml_mutations.h"

#include <tinyxml2.h>

#include <stdexcept>
#include <vector>

namespace fcl_stpbv::test {
namespace {

using tinyxml2::XMLElement;

std::string printed(const tinyxml2::XMLDocument& document) {
  tinyxml2::XMLPrinter printer(nullptr, true);
  document.Print(&printer);
  return printer.CStr();
}

std::vector<XMLElement*> elementsOf(tinyxml2::XMLDocument& document) {
  std::vector<XMLElement*> all{document.RootElement()};
  for (std::size_t i = 0; i < all.size(); ++i)
    for (XMLElement* e = all[i]->FirstChildElement(); e; e = e->NextSiblingElement()) all.push_back(e);
  return all;
}

std::string misspelt(const std::string& name) { return name.substr(0, name.size() - 1) + "x"; }

Mutation mutateElement(XMLElement& e, int kind) {
  const std::string name = e.Name();
  tinyxml2::XMLNode* parent = e.Parent();
  switch (kind % 5) {
    case 0:
      e.SetName(misspelt(name).c_str());
      return {"misspelt <" + name + ">", true};
    case 1:
      parent->InsertAfterChild(&e, e.DeepClone(e.GetDocument()));
      return {"doubled <" + name + ">", false};
    case 2:
      e.DeleteChildren();
      return {"emptied <" + name + ">", false};
    case 3:
      for (const char* broken : {"visual", "material", "inertial", "collision"})
        e.InsertFirstChild(e.GetDocument()->NewElement(broken));
      return {"empty elements in <" + name + ">", false};
    default:
      parent->DeleteChild(&e);
      return {"deleted <" + name + ">", false};
  }
}

Mutation mutateAttribute(XMLElement& e, const std::string& name, int kind) {
  const std::string value = e.Attribute(name.c_str()), where = " of <" + std::string(e.Name()) + ">";
  const std::vector<std::string> values = {"",     "x",       "nan nan nan", "1e999",
                                           "0 0",  "1,5 0 0", "0 0 0",       "-inf",
                                           "0x10", "1 2 3 4", value + " 1",  value + "e999"};
  if (kind % 3 == 0) {
    e.DeleteAttribute(name.c_str());
    e.SetAttribute(misspelt(name).c_str(), value.c_str());
    return {"misspelt " + name + where, true};
  }
  if (kind % 3 == 1) {
    const std::string& bad = values[static_cast<std::size_t>(kind / 3) % values.size()];
    e.SetAttribute(name.c_str(), bad.c_str());
    return {name + "=\"" + bad + "\"" + where, false};
  }
  e.DeleteAttribute(name.c_str());
  return {"no " + name + where, false};
}

}  // namespace

void forEachMutation(const std::string& text, int shift, std::size_t step,
                     const std::function<void(const std::string& mutated, const Mutation&)>& judge) {
  tinyxml2::XMLDocument whole;
  if (whole.Parse(text.c_str()) != tinyxml2::XML_SUCCESS) throw std::invalid_argument("no XML: " + text);
  const std::size_t count = elementsOf(whole).size();
  int kind = shift;
  for (std::size_t i = 0; i < count; i += step) {
    std::vector<std::string> attributes;
    for (const tinyxml2::XMLAttribute* a = elementsOf(whole)[i]->FirstAttribute(); a; a = a->Next())
      attributes.push_back(a->Name());
    for (std::size_t a = 0; a <= attributes.size(); ++a) {
      if (i == 0 && a == attributes.size()) continue;  // the root itself is not changed
      tinyxml2::XMLDocument document;
      whole.DeepCopy(&document);
      XMLElement& e = *elementsOf(document)[i];
      const Mutation mutation =
          a < attributes.size() ? mutateAttribute(e, attributes[a], ++kind) : mutateElement(e, ++kind);
      judge(printed(document), mutation);
    }
  }
}

}  // namespace fcl_stpbv::test
