// Preloaded: while the file that FATHOM_SLOW_DISK names is there, a write takes as long as on a disk of 1
// MB/s, and so does bringing it to the disk after it.

#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

static const double bytes_per_second = 1e6;
static const double seconds_of_sync = 0.05;

static int is_slow(void) {
  const char* file = getenv("FATHOM_SLOW_DISK");
  return file != NULL && access(file, F_OK) == 0;
}

static int is_recording(int fd) {
  char link[64], path[512];
  snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
  const ssize_t length = readlink(link, path, sizeof path);
  return length > 5 && memcmp(path + length - 5, ".mcap", 5) == 0;
}

static void take(double seconds) {
  struct timespec left = {(time_t)seconds, (long)(1e9 * (seconds - (double)(time_t)seconds))};
  while (nanosleep(&left, &left) != 0) {
  }
}

ssize_t write(int fd, const void* bytes, size_t size) {
  static ssize_t (*next)(int, const void*, size_t);
  if (next == NULL) next = (ssize_t(*)(int, const void*, size_t))dlsym(RTLD_NEXT, "write");
  if (is_slow() && is_recording(fd)) take((double)size / bytes_per_second);
  return next(fd, bytes, size);
}

int fdatasync(int fd) {
  static int (*next)(int);
  if (next == NULL) next = (int (*)(int))dlsym(RTLD_NEXT, "fdatasync");
  if (is_slow() && is_recording(fd)) take(seconds_of_sync);
  return next(fd);
}
