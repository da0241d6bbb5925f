// The arithmetics by name, and why a method cannot run in one of them.
#include <algorithm>

#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

const std::vector<std::string>& arithmetics() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all{"double", "compensated", "double-double"};
    if (has_quad_and_mp) all.insert(all.end(), {"quad", "mp(d)"});
    all.push_back("lattice");
    return all;
  }();
  return names;
}

int mp_digits(const std::string& arithmetic) {
  if (!arithmetic.starts_with("mp(") || !arithmetic.ends_with(")")) return 0;
  const std::string inside = arithmetic.substr(3, arithmetic.size() - 4);
  if (inside == "d") return 0;  // the name in lists
  const OptionInfo digits{.name = "d", .range = Range::whole_from(MpDigits::fewest, MpDigits::most)};
  if (!refused_value(digits, inside).empty()) {
    throw Error("found '" + arithmetic + "'; allowed mp(d) with d, its decimal digits, " + allowed_text(digits));
  }
  return static_cast<int>(number_value(inside));
}

int digits_beyond_double(const std::string& arithmetic) {
  if (arithmetic == "double-double") return 31;
  if (arithmetic == "quad") return 33;
  return mp_digits(arithmetic);
}

void check_arithmetic(const std::string& arithmetic) {
  const std::vector<std::string>& names = arithmetics();
  if (!has_quad_and_mp && (arithmetic == "quad" || arithmetic.starts_with("mp"))) {
    throw Error("found '" + arithmetic + "'; allowed " + joined(names) +
                "; a portable build has neither quad nor mp(d)");
  }
  if (mp_digits(arithmetic) > 0) return;
  if (arithmetic != "mp(d)" && std::find(names.begin(), names.end(), arithmetic) != names.end()) return;
  const std::string digits = arithmetic.starts_with("mp") ? arithmetic.substr(2) : "";
  const bool bare = !digits.empty() && digits.find_first_not_of("0123456789") == std::string::npos;  // mp50
  throw Error("found '" + arithmetic + "'; allowed " + joined(names) + (has_quad_and_mp ? ", e.g. mp(50)" : "") +
              (bare ? "; did you mean mp(" + digits + ")?" : suggestion(arithmetic, names)));
}

std::string refusal(const MethodSpec& spec, const std::string& arithmetic) {
  const MethodEntry& entry = find_method(spec.name);
  const MethodFamily& family = *entry.family;
  const int digits = digits_beyond_double(arithmetic);
  const int known = family.digits ? family.digits(entry.index) : unlimited_digits;
  if (digits > known) {
    return "the coefficients of " + spec.name + " are known here to " + std::to_string(known) +
           " digits; allowed up to mp(" + std::to_string(known) + ")";
  }
  if (arithmetic != "lattice" || (family.allowed_on_lattice && family.allowed_on_lattice(spec.options))) return "";
  return family.not_on_lattice;
}

}  // namespace hamflow
