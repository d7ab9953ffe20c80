/* Shared by the parts of ros2_peer. */
#pragma once

#include <stdio.h>
#include <stdlib.h>

#include "dds/dds.h"

static inline void check(dds_return_t code, const char* what) {
  if (code >= 0) return;
  fprintf(stderr, "ros2_peer: %s: %s\n", what, dds_strretcode(-code));
  exit(2);
}

/* Prints what a participant of ROS 2 says of its nodes, and what discovery says of it. Returns the exit code. */
int print_graph(dds_entity_t participant);
