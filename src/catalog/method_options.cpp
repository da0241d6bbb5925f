// A method as a text: "stv4", "cg(2,6)", "taylor(order=20)".
#include <algorithm>

#include "hamflow/core/text.hpp"
#include "hamflow/run/catalog.hpp"
#include "methods/step_control.hpp"

namespace hamflow {

namespace {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Removes quotation marks, as TOML has them; words need none here.
std::string unquoted(const std::string& text) {
  const bool quoted = text.size() >= 2 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front();
  return quoted ? text.substr(1, text.size() - 2) : text;
}

/// The options that may be given by position, in that order.
std::vector<const OptionInfo*> by_position(const std::vector<OptionInfo>& options) {
  std::vector<const OptionInfo*> all;
  for (const OptionInfo& option : options) {
    if (option.position > 0) all.push_back(&option);
  }
  std::sort(all.begin(), all.end(), [](const auto* a, const auto* b) { return a->position < b->position; });
  return all;
}

class OptionReader {
 public:
  OptionReader(const std::string& method, const std::vector<OptionInfo>& options)
      : method_(method), options_(options), positional_(by_position(options)) {}

  void read(const std::string& part, Texts& into) {
    const auto equals = part.find('=');
    const OptionInfo& option = equals == std::string::npos ? next() : named(trimmed(part.substr(0, equals)));
    const std::string text = unquoted(trimmed(equals == std::string::npos ? part : part.substr(equals + 1)));
    if (into.contains(option.name)) throw Error(method_ + ": " + option.name + ": found twice; allowed once");
    if (const std::string refused = refused_value(option, text); !refused.empty()) {
      throw Error(method_ + ": " + option.name + ": " + refused);
    }
    into[option.name] = text;
  }

 private:
  const OptionInfo& named(const std::string& name) const {
    if (const OptionInfo* option = find_option(options_, name)) return *option;
    const std::vector<std::string> names = option_names(options_);
    throw Error(method_ + ": found an unknown option '" + name + "'; allowed " + joined(names) +
                suggestion(name, names));
  }
  const OptionInfo& next() {
    if (at_ < positional_.size()) return *positional_[at_++];
    if (positional_.empty()) {
      throw Error(method_ + ": found an option without a name; allowed by name: " +
                  joined(options_, [](const OptionInfo& o) { return o.name + "=VALUE"; }));
    }
    throw Error(method_ + ": found more than " + std::to_string(positional_.size()) +
                " options without a name; allowed " + method_ + "(" +
                joined(positional_, [](const OptionInfo* o) { return o->name; }) + "), the others by name: NAME=VALUE");
  }

  const std::string& method_;
  const std::vector<OptionInfo>& options_;
  std::vector<const OptionInfo*> positional_;
  std::size_t at_ = 0;
};

}  // namespace

std::optional<RefusedOption> refused_option(const MethodSpec& spec) {
  const MethodFamily& family = *find_method(spec.name).family;
  for (const auto& [name, text] : spec.options) {
    const OptionInfo* option = find_option(family.options, name);
    if (option == nullptr) {
      const std::vector<std::string> names = option_names(family.options);
      return RefusedOption{name, "found an unknown option; allowed " + (names.empty() ? "none" : joined(names)) +
                                     suggestion(name, names)};
    }
    if (std::string refused = refused_value(*option, text); !refused.empty()) {
      return RefusedOption{name, std::move(refused)};
    }
  }
  if (auto refused = refused_step_control(spec)) return refused;
  if (!family.refused) return std::nullopt;
  auto [name, message] = family.refused(spec.options);
  return message.empty() ? std::nullopt : std::optional(RefusedOption{std::move(name), std::move(message)});
}

MethodSpec parse_method(const std::string& text) {
  MethodSpec spec;
  const auto open = text.find('(');
  spec.name = trimmed(text.substr(0, open));
  const std::vector<OptionInfo>& options = find_method(spec.name).family->options;
  if (open == std::string::npos) return spec;
  const std::string rest = trimmed(text.substr(open));
  if (const auto close = rest.rfind(')'); close == std::string::npos) {
    throw Error("found '" + text + "' without a closing parenthesis; allowed " + text + ")");
  } else if (close + 1 < rest.size()) {
    throw Error("found '" + text + "' with '" + trimmed(rest.substr(close + 1)) +
                "' after its closing parenthesis; allowed " + trimmed(text.substr(0, text.rfind(')') + 1)));
  }
  const std::string inside = trimmed(rest.substr(1, rest.size() - 2));
  if (inside.empty()) return spec;
  OptionReader reader(spec.name, options);
  for (const std::string& part : split_list(inside)) reader.read(part, spec.options);
  if (const auto refused = refused_option(spec))
    throw Error(spec.name + ": " + refused->name + ": " + refused->message);
  return spec;
}

}  // namespace hamflow
