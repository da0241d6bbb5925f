// Measures several methods on all cores, for `hamflow verify`.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hamflow/verify/measure.hpp"

namespace hamflow {

struct VerificationRequest {
  std::vector<std::string> methods;  // for example "cg(1,5)"
  bool all = false;                  // measure every method of the catalogue, in place of `methods`
  std::string problem{};             // empty: the default regions of each method
};

class Verification {
 public:
  /// Starts to measure at once, in background threads.
  /// @throws Rejection for unknown methods or an unknown problem   @throws Error if a method does not allow the problem
  explicit Verification(const VerificationRequest& request);
  /// Stops the measurements and waits until the threads have ended.
  ~Verification();
  Verification(const Verification&) = delete;
  Verification& operator=(const Verification&) = delete;

  /// Waits until every method is measured or `goes_on` returns false. `goes_on` is called 50 times a second.
  /// @return false if goes_on() did
  bool wait(const std::function<bool()>& goes_on);
  /// Returns the methods measured so far, in the order of the request. A method has two rows on a problem with walls.
  std::vector<PropertyRow> rows();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Returns property_json(), with "status": "interrupted" if the measurements were stopped.
std::string verification_json(const std::vector<PropertyRow>& rows, bool interrupted);

}  // namespace hamflow
