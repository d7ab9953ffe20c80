// Loaded before everything else into programs under ThreadSanitizer. gcc 12's libtsan does not intercept
// pthread_mutex_clocklock, with which Fast DDS locks its timed mutexes: it would see them only unlocked, and
// believe in cycles and races that are none. The same by pthread_mutex_timedlock, which it does intercept.

#define _GNU_SOURCE
#include <pthread.h>
#include <time.h>

enum { NS_PER_S = 1000000000 };

int pthread_mutex_clocklock(pthread_mutex_t* mutex, clockid_t clock, const struct timespec* until) {
  struct timespec now;
  struct timespec limit;
  clock_gettime(clock, &now);
  clock_gettime(CLOCK_REALTIME, &limit);
  limit.tv_sec += until->tv_sec - now.tv_sec;
  limit.tv_nsec += until->tv_nsec - now.tv_nsec;
  if (limit.tv_nsec < 0) {
    limit.tv_nsec += NS_PER_S;
    --limit.tv_sec;
  } else if (limit.tv_nsec >= NS_PER_S) {
    limit.tv_nsec -= NS_PER_S;
    ++limit.tv_sec;
  }
  return pthread_mutex_timedlock(mutex, &limit);
}
