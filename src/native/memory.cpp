#include "memory.hpp"

#include <stdexcept>
#include <string>

namespace hamflow::native {
namespace {

/// The allocator maps pages twice, once for writing and once for execution.
std::shared_ptr<asmjit::JitAllocator> shared_allocator() {
  static const auto allocator = [] {
    asmjit::JitAllocator::CreateParams options;
    options.options = asmjit::JitAllocatorOptions::kUseDualMapping;
    return std::make_shared<asmjit::JitAllocator>(&options);
  }();
  return allocator;
}

class MappedFunction final : public Function {
 public:
  MappedFunction(std::shared_ptr<asmjit::JitAllocator> allocator, void* code, std::size_t bytes)
      : allocator_(std::move(allocator)), code_(code), bytes_(bytes) {}
  ~MappedFunction() override { allocator_->release(code_); }
  MappedFunction(const MappedFunction&) = delete;
  MappedFunction& operator=(const MappedFunction&) = delete;
  Entry entry() const override { return reinterpret_cast<Entry>(code_); }
  std::size_t bytes() const override { return bytes_; }

 private:
  std::shared_ptr<asmjit::JitAllocator> allocator_;  // shared, so that it lives as long as any of its functions
  void* code_;
  std::size_t bytes_;
};

}  // namespace

void demand(asmjit::Error error) {
  if (error != asmjit::kErrorOk)
    throw std::logic_error("machine code: " + std::string(asmjit::DebugUtils::errorAsString(error)));
}

std::unique_ptr<const Function> made_executable(asmjit::CodeHolder& code) {
  demand(code.flatten());
  demand(code.resolveUnresolvedLinks());
  const std::size_t bytes = code.codeSize();
  const auto allocator = shared_allocator();
  void *runs = nullptr, *writes = nullptr;
  if (allocator->alloc(&runs, &writes, bytes) != asmjit::kErrorOk) return nullptr;
  auto function = std::make_unique<MappedFunction>(allocator, runs, bytes);
  demand(code.relocateToBase(reinterpret_cast<std::uintptr_t>(runs)));
  demand(code.copyFlattenedData(writes, bytes));
  return function;
}

}  // namespace hamflow::native
