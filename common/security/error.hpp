#pragma once

#include <stdexcept>

namespace fathom::security {

/// Credentials that cannot be made or used. what(): "FILE: what is wrong, what was expected" in one line.
class SecurityError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Credentials that the disk does not take.
class WriteError : public SecurityError {
 public:
  using SecurityError::SecurityError;
};

}  // namespace fathom::security
