// Simulations beyond double whose H has the constants of a run in double: a literal 1.3, m omega^2 and 1/m with their
// roundings. A reference solution is then one of the H that the run has.
#pragma once

namespace hamflow {

/// Problems that are made in this thread, until the scope ends, compute their constants in double.
class DoubleConstants {
 public:
  DoubleConstants() : before_(in_use) { in_use = true; }
  ~DoubleConstants() { in_use = before_; }
  DoubleConstants(const DoubleConstants&) = delete;
  DoubleConstants& operator=(const DoubleConstants&) = delete;
  static bool are_in_use() { return in_use; }

 private:
  static inline thread_local bool in_use = false;
  bool before_;
};

}  // namespace hamflow
