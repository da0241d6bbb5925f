// Simulations beyond double with the rounded constants of a run in double: a literal 1.3, m omega^2 and 1/m. A
// reference solution then belongs to the same H as the run.
#pragma once

namespace hamflow {

/// While this object exists, problems made in this thread compute their constants in double.
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
