#include "figure_text.hpp"

#include <algorithm>

namespace hamflow::reproduction {

std::string plain_text(const std::string& enhanced) {
  std::string text;
  for (std::size_t i = 0; i < enhanced.size(); ++i) {
    const char c = enhanced[i];
    if (c == '{') {
      if (enhanced[i + 1] == '/') {  // a font, up to the blank behind its name
        i = std::min(enhanced.find(' ', i), enhanced.size());
      }
    } else if (c != '}' && c != '_') {
      text += c;
    }
  }
  return text;
}

}  // namespace hamflow::reproduction
