#include "varied.hpp"

#include <algorithm>
#include <cctype>
#include <limits>

#include "hamflow/core/number.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/formula/formula.hpp"

namespace hamflow {

namespace {

/// Returns the number of members if there is one for each combination.
std::size_t combinations(const std::vector<Vary>& keys) {
  std::size_t count = 1;
  for (const Vary& key : keys) {
    if (!key.formula.empty()) continue;
    if (key.count() > most_members / count) {
      throw Error("found more than 10000000 members; allowed fewer values for each key");
    }
    count *= key.count();
  }
  return count;
}

std::size_t common_length(const std::vector<Vary>& keys) {
  const Vary* first = nullptr;
  for (const Vary& key : keys) {
    if (!key.formula.empty()) continue;
    if (first == nullptr) first = &key;
    if (key.count() == first->count()) continue;
    throw Error("found " + std::to_string(first->count()) + " values of " + first->path + " and " +
                std::to_string(key.count()) + " of " + key.path + "; allowed lists of equal length");
  }
  return first == nullptr ? 1 : first->count();
}

bool has_word(const std::string& text, const std::string& word) {
  const auto is_letter = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
  };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !is_letter(text[at - 1])) && (end == text.size() || !is_letter(text[end]))) return true;
  }
  return false;
}

void refuse_length(std::size_t length) {
  constexpr std::size_t longest = 100'000;
  if (length > longest) throw Error("found a formula that is too long when its sums are written out");
}

/// Writes a formula without let and sum, with texts in place of its names. Sums and products of many terms, which nest
/// to the left, are written without inner brackets and without recursion.
std::string written_out(const formula::Graph& graph, int at, const std::vector<std::string>& values) {
  using formula::Op;
  const auto is_sum = [](Op op) { return op == Op::add || op == Op::subtract; };
  const auto is_product = [](Op op) { return op == Op::multiply || op == Op::divide; };
  const Op first = graph[at].op;
  std::vector<const formula::Node*> chain;
  for (; is_sum(first) ? is_sum(graph[at].op) : is_product(first) && is_product(graph[at].op); at = graph[at].a) {
    chain.push_back(&graph[at]);
    refuse_length(2 * chain.size());  // each term takes at least an operator and a digit
  }
  if (!chain.empty()) {
    std::string text = "(" + written_out(graph, at, values);
    for (; !chain.empty(); chain.pop_back()) {
      text += "+-*/"[static_cast<std::size_t>(chain.back()->op) - static_cast<std::size_t>(Op::add)];
      text += written_out(graph, chain.back()->b, values);
      refuse_length(text.size());
    }
    return text + ")";
  }
  const formula::Node& node = graph[at];
  if (node.op == Op::number) return graph.text(node);
  if (node.op == Op::pi) return "pi";
  if (node.op == Op::symbol) return "(" + values.at(static_cast<std::size_t>(node.a)) + ")";
  const std::string a = written_out(graph, node.a, values);
  const std::string b = takes_two(node.op) ? written_out(graph, node.b, values) : "";
  refuse_length(a.size() + b.size());
  if (node.op == Op::negate) return "(-" + a + ")";
  if (node.op == Op::power) return "(" + a + "^" + b + ")";
  for (const NamedFunction& function : named_functions()) {
    if (function.operation == node.op) return std::string(function.name) + "(" + a + (b.empty() ? "" : ", " + b) + ")";
  }
  return a;
}
}  // namespace

Varied::Varied(std::vector<Vary> keys, bool in_step) : keys_(std::move(keys)), in_step_(in_step) {
  members_ = in_step ? common_length(keys_) : combinations(keys_);
  for (std::size_t key = 0; key < keys_.size(); ++key) check_formula(key, {});
}

std::size_t Varied::key_of(const std::string& path) const {
  const auto found = std::find_if(keys_.begin(), keys_.end(), [&](const Vary& key) { return key.path == path; });
  return static_cast<std::size_t>(found - keys_.begin());
}

/// @param behind keys whose formulas lead to this one
void Varied::check_formula(std::size_t key, std::vector<std::size_t> behind) {
  const Vary& own = keys_[key];
  const std::string in_formula = own.path + ": found ";
  std::vector<std::string> others;
  for (const Vary& other : keys_) {
    if (&other != &own && other.is_number()) others.push_back(other.path);
  }
  behind.push_back(key);
  for (const NamedPath& named : paths_in(own.formula)) {
    const std::size_t other = key_of(named.path);
    const std::string column = ", column " + std::to_string(named.at + 1) + " of its formula";
    if (other == keys_.size() || other == key || !keys_[other].is_number()) {
      throw Error(in_formula + named.path + column + "; allowed other varied keys with numbers" +
                  (others.empty() ? ", and there are none" : ": " + joined(others)) + suggestion(named.path, others));
    }
    if (std::find(behind.begin(), behind.end(), other) != behind.end()) {
      throw Error(in_formula + named.path + column + ", which itself depends on " + own.path +
                  "; allowed formulas of keys that have values");
    }
    check_formula(other, behind);
  }
  if (own.formula.empty() || behind.size() > 1) return;
  try {
    const Formula formula = parse_formula(own.formula, {.names = others, .known = {}, .what = "other varied keys"});
    if (has_word(own.formula, "let") || has_word(own.formula, "sum")) {
      formulas_[key] = std::make_shared<const Formula>(formula);
    }
  } catch (const Error& error) {
    throw Error(own.path + ": " + error.what());
  }
}

std::vector<std::size_t> Varied::free_keys() const {
  std::vector<std::size_t> all;
  for (std::size_t key = 0; key < keys_.size(); ++key) {
    if (keys_[key].formula.empty() && (all.empty() || !in_step_)) all.push_back(key);
  }
  return all;
}

std::vector<std::string> Varied::paths() const {
  std::vector<std::string> all;
  for (const Vary& key : keys_) all.push_back(key.path);
  return all;
}

std::size_t Varied::place(std::size_t member, std::size_t key) const {
  if (!keys_[key].formula.empty()) return 0;
  if (in_step_) return member;
  for (std::size_t k = keys_.size(); k-- > key + 1;) {
    if (keys_[k].formula.empty()) member /= keys_[k].count();
  }
  return member % keys_[key].count();
}

std::string Varied::text(std::size_t member, std::size_t key) const {
  const Vary& own = keys_[key];
  if (own.formula.empty()) return own.text(place(member, key));
  std::string all;
  if (const auto formula = formulas_.find(key); formula != formulas_.end()) {
    std::vector<std::string> values;
    for (std::size_t other = 0; other < keys_.size(); ++other) {
      if (other != key && keys_[other].is_number()) {
        const bool named = formula->second->uses(static_cast<int>(values.size()));
        values.push_back(named ? without_quotes(text(member, other)) : "0");
      }
    }
    return written_out(formula->second->graph(), formula->second->root(), values);
  }
  std::size_t done = 0;
  for (const NamedPath& named : paths_in(own.formula)) {
    all += own.formula.substr(done, named.at - done) + "(" + without_quotes(text(member, key_of(named.path))) + ")";
    done = named.at + named.path.size();
  }
  return all + own.formula.substr(done);
}

double Varied::number(std::size_t member, std::size_t key) const {
  const Vary& own = keys_[key];
  if (own.formula.empty()) return own.number(place(member, key));
  try {
    return evaluate_number<double>(text(member, key));
  } catch (const Error&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

std::string Varied::without_start(std::size_t member, std::size_t key) const {
  const Vary& own = keys_[key];
  const auto starts = {"problem.initial.", "problem.orbit."};
  const bool of_start =
      std::any_of(starts.begin(), starts.end(), [&](const char* path) { return own.path.starts_with(path); });
  if (own.formula.empty() || !of_start) return {};
  try {
    (void)evaluate_number<double>(text(member, key));
    return {};
  } catch (const Error& error) {
    return own.path + ": " + as_typed(error.what(), member);
  }
}

std::string Varied::described(std::size_t member) const {
  std::string all = "member " + std::to_string(member);
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    all +=
        (k == 0 ? ": " : ", ") + keys_[k].path + "=" + (keys_[k].formula.empty() ? text(member, k) : keys_[k].formula);
  }
  return all;
}

std::string Varied::as_typed(std::string complaint, std::size_t member) const {
  for (std::size_t key = 0; key < keys_.size(); ++key) {
    const std::string& formula = keys_[key].formula;
    if (formula.empty()) continue;
    const std::string found = "found \"" + text(member, key) + "\"";
    const std::size_t at = complaint.find(found);
    if (at == std::string::npos) continue;
    // "column N" refers to the text with inserted values, not to the typed text, so it is left out.
    const std::string column = ", column ";
    std::size_t end = at + found.size();
    if (complaint.compare(end, column.size(), column) == 0) {
      end = std::min(complaint.find_first_not_of("0123456789", end + column.size()), complaint.size());
    }
    std::string values;
    for (std::size_t other = 0; other < keys_.size(); ++other) {
      if (!keys_[other].formula.empty() || !keys_[other].is_number()) continue;
      values += (values.empty() ? " where " : ", ") + keys_[other].path + "=" + text(member, other);
    }
    complaint.replace(at, end - at, "found \"" + formula + "\"" + values);
    break;
  }
  return complaint;
}

}  // namespace hamflow
