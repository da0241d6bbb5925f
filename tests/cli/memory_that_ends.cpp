// Put before the C++ library (LD_PRELOAD), refuses one large allocation of hamflow (not of gnuplot): what was allocated
// is given back then, and there is memory again. Where memory ends is so a number and no matter of chance. Small ones
// succeed, for libraries that read and write crash without.
//     HAMFLOW_TEST_LARGE     what is large, in bytes
//     HAMFLOW_TEST_REFUSED   the one that is refused, from 0 [none]
//     HAMFLOW_TEST_COUNT_IN  a file that gets their number when the command ends
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

namespace {

std::size_t number(const char* name, std::size_t without) {
  const char* const text = std::getenv(name);
  return text == nullptr ? without : std::strtoull(text, nullptr, 10);
}

const bool of_the_command = std::strncmp(program_invocation_short_name, "hamflow", 7) == 0;
std::atomic<std::size_t> seen{0};

void* allocated(std::size_t bytes, std::size_t alignment) {
  static const std::size_t large = number("HAMFLOW_TEST_LARGE", 1 << 16);
  static const std::size_t refused = number("HAMFLOW_TEST_REFUSED", static_cast<std::size_t>(-1));
  if (of_the_command && bytes >= large && seen++ == refused) throw std::bad_alloc();
  void* const memory = alignment == 0 ? std::malloc(bytes) : std::aligned_alloc(alignment, bytes);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

struct Counted {
  ~Counted() {
    const char* const path = std::getenv("HAMFLOW_TEST_COUNT_IN");
    if (path == nullptr || !of_the_command) return;
    if (std::FILE* const file = std::fopen(path, "w")) {
      std::fprintf(file, "%zu\n", seen.load());
      std::fclose(file);
    }
  }
} at_the_end;

}  // namespace

void* operator new(std::size_t bytes) { return allocated(bytes == 0 ? 1 : bytes, 0); }
void* operator new[](std::size_t bytes) { return allocated(bytes == 0 ? 1 : bytes, 0); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  const auto to = static_cast<std::size_t>(alignment);
  return allocated((bytes + to - 1) / to * to, to);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
