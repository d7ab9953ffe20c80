#include "runtime/leave.hpp"

#include <cstdio>
#include <cstdlib>

namespace fathom::runtime {

int leave(int exit_code) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return exit_code;
#else
  abandon(exit_code);
#endif
}

void abandon(int exit_code) {
  std::fflush(stdout);  // standard error keeps nothing back, and a thread may hang in it
  std::_Exit(exit_code);
}

}  // namespace fathom::runtime
