#include "runtime/leave.hpp"

#include <cstdio>
#include <cstdlib>

namespace fathom::runtime {

int leave(int exit_code) {
  std::fflush(nullptr);
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return exit_code;
#else
  std::_Exit(exit_code);
#endif
}

}  // namespace fathom::runtime
