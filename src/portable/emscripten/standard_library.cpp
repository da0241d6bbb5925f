// What standard_library.hpp declares.
#include "portable/emscripten/standard_library.hpp"

#include "portable/emscripten/shortest_text.hpp"

namespace std {

to_chars_result to_chars(char* first, char* last, double x) {
  const string text = hamflow::shortest_text(x);
  if (static_cast<size_t>(last - first) < text.size()) return {last, errc::value_too_large};
  memcpy(first, text.data(), text.size());
  return {first + text.size(), errc()};
}

}  // namespace std
