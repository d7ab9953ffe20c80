#pragma once

#include <cerrno>

#include <dirent.h>
#include <dlfcn.h>

namespace fathom::test {

/// Entries of folders that are read before the disk fails; -1: it does not fail. One source file of a test
/// includes this: it takes the place of readdir() in the whole process.
inline int entries_until_failure = -1;

}  // namespace fathom::test

extern "C" dirent* readdir(DIR* folder) {
  int& left = fathom::test::entries_until_failure;
  if (left == 0) {
    errno = EIO;
    return nullptr;
  }
  left = left > 0 ? left - 1 : left;
  static const auto real = reinterpret_cast<dirent* (*)(DIR*)>(dlsym(RTLD_NEXT, "readdir"));
  return real(folder);
}
