// Several methods measured, on all cores: what `hamflow verify` does.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hamflow/verify/measure.hpp"

namespace hamflow {

struct VerificationRequest {
  std::vector<std::string> methods;  // e.g. "cg(1,5)"
  bool all = false;                  // every method of the catalogue, in place of `methods`
  std::string problem{};             // empty: the default regions of each method
};

class Verification {
 public:
  /// Measuring begins at once, in threads of its own.
  /// @throws Rejection for unknown methods or an unknown problem   @throws Error when a method refuses the problem
  explicit Verification(const VerificationRequest& request);
  /// Gives up the methods that are being measured, and waits until they are left.
  ~Verification();
  Verification(const Verification&) = delete;
  Verification& operator=(const Verification&) = delete;

  /// Until every method is measured, or `goes_on`, asked 50 times a second, returns false.
  /// @return false when it did
  bool wait(const std::function<bool()>& goes_on);
  /// The methods measured so far, in the order of the request; on a problem with walls two rows each.
  std::vector<PropertyRow> rows();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// property_json(), and "status": "interrupted" where measuring was stopped.
std::string verification_json(const std::vector<PropertyRow>& rows, bool interrupted);

}  // namespace hamflow
