#include "embedded.hpp"

#include "embedded_texts.hpp"
#include "hamflow/core/error.hpp"

namespace hamflow::reproduction {

const std::string& embedded_text(const std::string& file) {
  const auto found = embedded_texts().find(file);
  if (found == embedded_texts().end()) throw Error("found no " + file + " in the program");
  return found->second;
}

}  // namespace hamflow::reproduction
