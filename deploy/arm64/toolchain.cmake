# Cross-compilation for 64-bit ARM on Debian 12 (cmake --preset arm64). The libraries are Debian's arm64 packages: those
# of this machine (multiarch), or those in a folder named by FATHOM_SYSROOT (deploy/arm64/sysroot makes one).
# Code generators (fastddsgen, npm) are this machine's own.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)

# CMake reads this file again for each of its own trials, where the cache is not seen.
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES FATHOM_SYSROOT)
if(NOT FATHOM_SYSROOT AND DEFINED ENV{FATHOM_SYSROOT})
  set(FATHOM_SYSROOT $ENV{FATHOM_SYSROOT} CACHE PATH "Folder of Debian's arm64 packages; empty: this machine's multiarch")
endif()

set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
if(FATHOM_SYSROOT)
  set(CMAKE_SYSROOT ${FATHOM_SYSROOT})
  set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
  set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
  set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
  set(ENV{PKG_CONFIG_SYSROOT_DIR} ${FATHOM_SYSROOT})
endif()
set(ENV{PKG_CONFIG_LIBDIR}
    ${FATHOM_SYSROOT}/usr/lib/aarch64-linux-gnu/pkgconfig:${FATHOM_SYSROOT}/usr/share/pkgconfig)

# Where qemu-user-static is installed, ctest runs the tests with it.
find_program(FATHOM_QEMU qemu-aarch64-static)
if(FATHOM_QEMU)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${FATHOM_QEMU};-L;${FATHOM_SYSROOT}/)
endif()
