// **Text of messages**: lists of names, and the name that was probably meant.
#pragma once

#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hamflow {

/// "a, b, c".
std::string joined(std::span<const std::string> words, std::string_view separator = ", ");

/// The same of `text_of(element)` for every element of a range.
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

/// The parts of "verlet, cg(1,5), [1, 2]" without the spaces around them: commas within parentheses and brackets do not
/// split.
std::vector<std::string> split_list(const std::string& text);

/// The candidate nearest to `name` by edit distance, large and small letters alike, the first of several; else the
/// first that begins with `name`, of three characters at least. Empty if none is near, that is if more than a third of
/// the name (of four characters one), or all of it, would have to change.
std::string nearest(const std::string& name, std::span<const std::string> candidates);

/// "; did you mean NAME?" with the nearest candidate, or nothing if none is near.
std::string suggestion(const std::string& name, std::span<const std::string> candidates);

}  // namespace hamflow
