// The declarations of problems, methods and keys as JSON: the page makes completions and sliders of them.
#include <emscripten.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "hamflow/run/catalog.hpp"
#include "run_keys.hpp"

namespace hamflow {
namespace {

using Json = nlohmann::ordered_json;

const char* name_of(OptionType type) {
  switch (type) {
    case OptionType::number:
      return "number";
    case OptionType::list:
      return "list";
    case OptionType::number_or_list:
      return "number_or_list";
    case OptionType::word:
      return "word";
    case OptionType::word_list:
      return "word_list";
    case OptionType::yes_no:
      return "yes_no";
    case OptionType::text:
      return "text";
    case OptionType::table:
      return "table";
  }
  return "";
}

template <class Options>
Json declared(const Options& options) {
  Json all = Json::array();
  const auto bound = [](double x) { return std::isfinite(x) ? Json(x) : Json(); };
  for (const OptionInfo& each : options) {
    all.push_back({{"name", each.name},
                   {"type", name_of(each.type)},
                   {"default", each.default_value},
                   {"meaning", each.meaning},
                   {"words", each.words},
                   {"least", bound(each.range.least)},
                   {"most", bound(each.range.most)},
                   {"whole", each.range.whole},
                   {"unit", each.unit},
                   {"keys", declared(each.keys)}});
  }
  return all;
}

Json all_declarations() {
  Json tables = Json::object();
  for (const DeclaredTable& table : declared_tables()) tables[table.name] = declared(table.keys);
  Json declared_problems = Json::array();
  const auto add = [&](const ProblemInfo& info) {
    Json choices = Json::object();
    for (const auto& [key, value] : info.variant) choices[key] = value;
    declared_problems.push_back(
        {{"name", info.name}, {"choices", choices}, {"formula", info.formula}, {"keys", declared(keys_of(info))}});
  };
  for (const ProblemEntry& each : problems()) add(each.info);
  add(formula_example().info);
  Json declared_methods = Json::array();
  for (const MethodEntry& each : methods()) {
    declared_methods.push_back({{"name", each.name},
                                {"purpose", advice({.name = each.name}).purpose},
                                {"keys", declared(each.family->options)}});
  }
  return {{"tables", tables},
          {"problems", declared_problems},
          {"methods", declared_methods},
          {"arithmetics", arithmetics()}};
}

}  // namespace
}  // namespace hamflow

extern "C" EMSCRIPTEN_KEEPALIVE const char* hamflow_declarations(int) {
  static const std::string all = hamflow::all_declarations().dump();
  return all.c_str();
}
