#pragma once

#include <string>
#include <system_error>

namespace fathom::runtime {

/// Other processes that have a serial port open, e.g. "process 812 (fathom-gps-bridge)"; empty where there is
/// none, or where this user may not see what another user's process has open. The process that makes a
/// pseudo-terminal is its device and holds nothing.
[[nodiscard]] std::string serial_holders(const std::string& path);

/// Who keeps a serial port from being opened alone, as serial_holders() does; "another process" where one
/// does and cannot be seen. Empty also where the port cannot be opened for another reason.
[[nodiscard]] std::string serial_occupant(const std::string& path);

/// An open serial port for this process alone, as long as it lives: against others of fathom by a lock on the
/// device, against the rest by the mode TIOCEXCL, which stops all but root. A pseudo-terminal gets no such
/// mode: its device holds it open, so that the mode would outlive a reader that was killed.
class SerialClaim {
 public:
  /// Throws std::runtime_error where another process has it.
  SerialClaim(int descriptor, const std::string& path);
  ~SerialClaim();
  SerialClaim(const SerialClaim&) = delete;
  SerialClaim& operator=(const SerialClaim&) = delete;
  /// Before the descriptor is closed.
  void release();

 private:
  int exclusive_ = -1;
};

/// Why a serial port cannot be opened, and what helps where the rights are missing.
[[nodiscard]] std::string serial_trouble(const std::string& path, const std::error_code& error);

}  // namespace fathom::runtime
