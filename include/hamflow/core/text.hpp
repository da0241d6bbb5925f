// **Texts of messages**: lists of names, and proposals for misspelt names.
#pragma once

#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hamflow {

/// "a, b, c".
std::string joined(std::span<const std::string> words, std::string_view separator = ", ");

/// Joins text_of(element) for every element of a range.
template <class Range, class TextOf>
requires requires(const Range& range, const TextOf& text_of) { std::string(text_of(*std::begin(range))); }
std::string joined(const Range& range, const TextOf& text_of, std::string_view separator = ", ") {
  std::string all;
  bool first = true;
  for (const auto& element : range) {
    if (!first) all += separator;
    all += text_of(element);
    first = false;
  }
  return all;
}

/// Splits "verlet, cg(1,5), [1, 2]" at commas outside parentheses and brackets, and removes the spaces around each
/// part.
std::vector<std::string> split_list(const std::string& text);

/// The candidate nearest to `name` by edit distance, ignoring case, the first of several; otherwise the first candidate
/// that begins with `name`, if that has at least three characters. Empty if none is near, that is, if more than a third
/// of the name (one of four characters) or all of it would have to change.
std::string nearest(const std::string& name, std::span<const std::string> candidates);

/// "; did you mean NAME?" with the nearest candidate; empty if none is near.
std::string suggestion(const std::string& name, std::span<const std::string> candidates);

}  // namespace hamflow
