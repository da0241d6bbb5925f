// A method on the command line: "stv4", "cg(2,6)", "taylor(order=20)".
#include <algorithm>
#include <cmath>

#include "hamflow/core/number.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

namespace {
std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

double number(const std::string& method, const std::string& key, const std::string& text) {
  try {
    return evaluate_number<double>(text);
  } catch (const Error& error) {
    throw Error(method + ": " + key + ": " + error.what());
  }
}

int whole_number(const std::string& method, const std::string& key, const std::string& text) {
  double value = 0.5;
  try {
    value = evaluate_number<double>(text);
  } catch (const Error&) {  // no whole number either
  }
  if (value != static_cast<double>(static_cast<int>(std::clamp(value, -1e6, 1e6)))) {
    throw Error(method + ": " + key + " has to be a whole number, not '" + text + "'");
  }
  return static_cast<int>(value);
}

double positive_number(const std::string& method, const std::string& key, const std::string& text) {
  const double value = number(method, key, text);
  if (!(value > 0)) throw Error(method + ": " + key + " has to be positive, not " + text);
  return value;
}

void set_cg_option(CgOptions& cg, const std::string& key, const std::string& value) {
  if (key == "degree") {
    cg.degree = whole_number("cg", key, value);
    if (cg.degree != 1) throw Error("cg: degree is 1 in this version, not " + value);
  } else if (key == "quadrature") {
    cg.quadrature = value == "auto" ? 0 : whole_number("cg", key, value);
    if (value != "auto" && (cg.quadrature < cg.degree || cg.quadrature > 64)) {
      throw Error("cg: quadrature is a number of Gauss points from the degree to 64, or auto, not " + value);
    }
  } else if (key == "tolerance") {
    cg.tolerance = positive_number("cg", key, value);
  } else {
    throw Error("cg: option '" + key + "' is unknown; allowed: degree, quadrature, tolerance");
  }
}

void set_adaptive_option(const std::string& method, AdaptiveOptions& options, const std::string& key,
                         const std::string& value) {
  if (key == "tolerance") {
    options.tolerance = positive_number(method, key, value);
    options.tolerance_given = true;
    if (options.tolerance >= 1) throw Error(method + ": tolerance has to be less than 1, not " + value);
  } else if (key == "order" && method == "taylor") {
    options.order = whole_number(method, key, value);
    if (options.order < least_taylor_order || options.order > most_taylor_order) {
      throw Error("taylor: order is a whole number from " + std::to_string(least_taylor_order) + " to " +
                  std::to_string(most_taylor_order) + ", not " + value);
    }
  } else if (key == "step_control") {
    if (value != "adaptive" && value != "fixed") {
      throw Error(method + ": step_control is adaptive or fixed, not " + value);
    }
    options.fixed = value == "fixed";
  } else {
    throw Error(method + ": option '" + key + "' is unknown; allowed: tolerance, step_control" +
                (method == "taylor" ? ", order" : ""));
  }
}
}  // namespace

int taylor_order(const AdaptiveOptions& options) {
  return options.order > 0 ? options.order : static_cast<int>(std::ceil(1 - std::log(options.tolerance) / 2));
}

MethodSpec parse_method(const std::string& text) {
  MethodSpec spec;
  const auto open = text.find('(');
  spec.name = trimmed(text.substr(0, open));
  const MethodEntry& entry = find_method(spec.name);
  if (open == std::string::npos) return spec;
  if (text.back() != ')') throw Error("method '" + text + "' lacks its closing parenthesis");
  std::vector<std::string> in_order;
  if (entry.kind == MethodKind::cg) in_order = {"degree", "quadrature"};
  if (entry.kind == MethodKind::dop853) in_order = {"tolerance"};
  if (entry.kind == MethodKind::taylor) in_order = {"order", "tolerance"};
  if (in_order.empty()) throw Error("method '" + spec.name + "' takes no options");
  const auto set = [&](const std::string& key, const std::string& value) {
    if (entry.kind == MethodKind::cg) {
      set_cg_option(spec.cg, key, value);
    } else {
      set_adaptive_option(spec.name, spec.adaptive, key, value);
    }
  };
  const std::string inside = text.substr(open + 1, text.size() - open - 2);
  std::size_t position = 0;
  for (std::size_t begin = 0; begin <= inside.size();) {
    const std::size_t end = std::min(inside.find(',', begin), inside.size());
    const std::string part = trimmed(inside.substr(begin, end - begin));
    const auto equals = part.find('=');
    if (equals != std::string::npos) {
      set(trimmed(part.substr(0, equals)), trimmed(part.substr(equals + 1)));
    } else if (position < in_order.size()) {
      set(in_order[position++], part);
    } else {
      std::string all;
      for (const std::string& key : in_order) all += (all.empty() ? "" : ", ") + key;
      throw Error("method '" + text + "' has too many options; " + spec.name + " takes (" + all + ")");
    }
    begin = end + 1;
  }
  return spec;
}

}  // namespace hamflow
