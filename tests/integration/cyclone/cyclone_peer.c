/* cyclone_peer ROLE DOMAIN: a Cyclone DDS participant for the tests.
 * nav_state, alignment, route: prints the first sample received, one "field value" a line, and exits 0.
 * count_imu, count_nav_state: receives until a sample of no vehicle ends it; prints the first number, how
 * many came, how many numbers were missing, how many were not in order or came twice, the longest pause in
 * ms, and how many writers. gps: publishes GpsSample every 20 ms until it is killed. Exits 1 after 20 s
 * without a sample. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "dds/dds.h"
#include "guidance.h"
#include "navigation.h"
#include "sensors.h"

static void check(dds_return_t code, const char* what) {
  if (code >= 0) return;
  fprintf(stderr, "cyclone_peer: %s: %s\n", what, dds_strretcode(-code));
  exit(2);
}

static void print_array(const char* name, const double* values, size_t n) {
  printf("%s", name);
  for (size_t i = 0; i < n; ++i) printf(" %.17g", values[i]);
  printf("\n");
}
#define PRINT_ARRAY(sample, field) \
  print_array(#field, (sample)->field, sizeof((sample)->field) / sizeof(double))
#define PRINT(sample, field) printf(#field " %.17g\n", (sample)->field)

static void print_nav_state(const void* data) {
  const fathom_v1_NavState* s = data;
  printf("vehicle %s\nsensor %s\n", s->vehicle, s->sensor);
  printf("stamp_ns %lld\nreceived_ns %lld\n", (long long)s->stamp_ns, (long long)s->received_ns);
  printf("sequence_number %llu\n", (unsigned long long)s->sequence_number);
  printf("mode %d\nalignment %d\n", (int)s->mode, (int)s->alignment);
  PRINT(s, latitude_rad);
  PRINT(s, longitude_rad);
  PRINT(s, altitude_m);
  PRINT(s, depth_m);
  PRINT_ARRAY(s, velocity_N_m_s);
  PRINT_ARRAY(s, q_NB);
  PRINT_ARRAY(s, rpy_rad);
  PRINT_ARRAY(s, angular_rate_B_rad_s);
  PRINT_ARRAY(s, specific_force_B_m_s2);
  PRINT_ARRAY(s, position_covariance_N_m2);
  PRINT_ARRAY(s, velocity_covariance_N_m2_s2);
  PRINT_ARRAY(s, rpy_sigma_rad);
  PRINT(s, gps_outage_s);
  PRINT(s, dvl_outage_s);
  printf("reset_counter %u\n", (unsigned)s->reset_counter);
  PRINT_ARRAY(s, last_reset_delta_N_m);
}

static void print_alignment(const void* data) {
  const fathom_v1_AlignmentStatus* s = data;
  printf("vehicle %s\nphase %d\n", s->vehicle, (int)s->phase);
  PRINT(s, in_phase_s);
  printf("conditions %u\n", (unsigned)s->conditions._length);
  for (uint32_t i = 0; i < s->conditions._length; ++i) {
    const fathom_v1_AlignmentCondition* c = &s->conditions._buffer[i];
    printf("condition %s %.17g %.17g %.17g %.17g %d\n", c->name, c->value, c->limit, c->held_s, c->needed_s,
           c->met);
  }
  PRINT_ARRAY(s, rpy_sigma_rad);
  PRINT(s, time_to_aligned_s);
  printf("advice %s\n", s->advice);
}

static void print_route(const void* data) {
  const fathom_v1_Route* s = data;
  printf("vehicle %s\npublisher %s\n", s->vehicle, s->publisher);
  printf("active %u\nrepeats %d\n", (unsigned)s->active, s->repeats);
  printf("first_number %u\nmission_count %u\n", (unsigned)s->first_number, (unsigned)s->mission_count);
  PRINT(s, leg_start_latitude_rad);
  PRINT(s, leg_start_longitude_rad);
  for (uint32_t i = 0; i < s->waypoints._length; ++i) {
    const fathom_v1_RouteWaypoint* w = &s->waypoints._buffer[i];
    printf("waypoint '%s' %.17g %.17g %.17g %.17g\n", w->name, w->latitude_rad, w->longitude_rad, w->depth_m,
           w->speed_m_s);
  }
}

static int subscribe(dds_entity_t participant, const dds_topic_descriptor_t* type, const char* name,
                     dds_qos_t* qos, void (*print)(const void*)) {
  const dds_entity_t topic = dds_create_topic(participant, type, name, NULL, NULL);
  check(topic, "topic");
  const dds_entity_t reader = dds_create_reader(participant, topic, qos, NULL);
  check(reader, "reader");
  for (int i = 0; i < 2000; ++i) {
    void* samples[1] = {NULL};
    dds_sample_info_t info[1];
    const dds_return_t taken = dds_take(reader, samples, info, 1, 1);
    check(taken, "take");
    if (taken == 1 && info[0].valid_data) {
      print(samples[0]);
      return 0;
    }
    dds_sleepfor(DDS_MSECS(10));
  }
  dds_requested_incompatible_qos_status_t status;
  check(dds_get_requested_incompatible_qos_status(reader, &status), "status");
  fprintf(stderr, "cyclone_peer: no sample; incompatible QoS: %u, policy %u\n", status.total_count,
          status.last_policy_id);
  return 1;
}

/* What has been counted of one source. */
struct Count {
  unsigned long long first, received, missing, not_in_order, newest;
  dds_instance_handle_t writer;
  unsigned writers;
  dds_time_t last;
  dds_time_t pause;
};

static void count_one(struct Count* count, unsigned long long number, dds_instance_handle_t writer) {
  const dds_time_t now = dds_time();
  if (count->received > 0) {
    if (now - count->last > count->pause) count->pause = now - count->last;
    if (number <= count->newest) {
      ++count->not_in_order;
    } else {
      count->missing += number - count->newest - 1;
    }
  } else {
    count->first = number;
  }
  if (writer != count->writer) ++count->writers;
  count->writer = writer;
  count->last = now;
  if (number > count->newest) count->newest = number;
  ++count->received;
}

/* The last sample is of no vehicle. */
static int count_samples(dds_entity_t participant, const dds_topic_descriptor_t* type, const char* name,
                         dds_qos_t* qos, int of_imu) {
  dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
  const dds_entity_t topic = dds_create_topic(participant, type, name, NULL, NULL);
  check(topic, "topic");
  const dds_entity_t reader = dds_create_reader(participant, topic, qos, NULL);
  check(reader, "reader");
  check(dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS), "status mask");
  const dds_entity_t waitset = dds_create_waitset(participant);
  check(dds_waitset_attach(waitset, reader, 0), "attach");
  struct Count count;
  memset(&count, 0, sizeof count);
  for (;;) {
    if (dds_waitset_wait(waitset, NULL, 0, DDS_SECS(20)) <= 0) return 1;
    void* samples[64] = {NULL};
    dds_sample_info_t info[64];
    const dds_return_t taken = dds_take(reader, samples, info, 64, 64);
    check(taken, "take");
    int ended = 0;
    for (dds_return_t i = 0; i < taken; ++i) {
      if (!info[i].valid_data) continue;
      const fathom_v1_ImuSample* imu = samples[i];
      const fathom_v1_NavState* state = samples[i];
      if (strcmp(of_imu ? imu->vehicle : state->vehicle, "") == 0) {
        ended = 1;
      } else {
        count_one(&count, of_imu ? imu->sequence_number : state->sequence_number, info[i].publication_handle);
      }
    }
    if (taken > 0) check(dds_return_loan(reader, samples, taken), "return loan");
    if (ended) break;
  }
  printf("first %llu received %llu missing %llu not_in_order %llu pause_ms %lld writers %u\n", count.first,
         count.received, count.missing, count.not_in_order, (long long)(count.pause / 1000000),
         count.writers);
  return 0;
}

_Noreturn static void publish_gps(dds_entity_t participant, dds_qos_t* qos) {
  const dds_entity_t topic =
      dds_create_topic(participant, &fathom_v1_GpsSample_desc, "fathom/v1/gps", NULL, NULL);
  check(topic, "topic");
  const dds_entity_t writer = dds_create_writer(participant, topic, qos, NULL);
  check(writer, "writer");
  fathom_v1_GpsSample sample;
  memset(&sample, 0, sizeof sample);
  strcpy(sample.vehicle, "auv");
  strcpy(sample.sensor, "gps-of-another-vendor");
  sample.stamp_ns = 1700000000123456789LL;
  sample.fix = fathom_v1_GPS_FIX_RTK_FIXED;
  sample.satellites = 17;
  sample.latitude_rad = 0.635;
  sample.longitude_rad = -1.25;
  for (int i = 0; i < 3; ++i) sample.velocity_N_m_s[i] = 0.5 * i;
  for (;;) {
    ++sample.sequence_number;
    check(dds_write(writer, &sample), "write");
    dds_sleepfor(DDS_MSECS(20));
  }
}

int main(int argc, char** argv) {
  if (argc != 3) {
    fprintf(stderr, "usage: cyclone_peer nav_state|alignment|route|count_imu|count_nav_state|gps DOMAIN\n");
    return 2;
  }
  const dds_entity_t participant =
      dds_create_participant((dds_domainid_t)strtoul(argv[2], NULL, 10), NULL, NULL);
  check(participant, "participant");
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
  if (strcmp(argv[1], "nav_state") == 0) {
    dds_qset_ownership(qos, DDS_OWNERSHIP_EXCLUSIVE);
    dds_qset_deadline(qos, DDS_MSECS(30));
    return subscribe(participant, &fathom_v1_NavState_desc, "fathom/v1/nav_state", qos, print_nav_state);
  }
  if (strcmp(argv[1], "count_imu") == 0) {
    return count_samples(participant, &fathom_v1_ImuSample_desc, "fathom/v1/imu", qos, 1);
  }
  if (strcmp(argv[1], "count_nav_state") == 0) {
    dds_qset_ownership(qos, DDS_OWNERSHIP_EXCLUSIVE);
    return count_samples(participant, &fathom_v1_NavState_desc, "fathom/v1/nav_state", qos, 0);
  }
  if (strcmp(argv[1], "alignment") == 0) {
    dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
    dds_qset_deadline(qos, DDS_SECS(3));
    return subscribe(participant, &fathom_v1_AlignmentStatus_desc, "fathom/v1/alignment", qos,
                     print_alignment);
  }
  if (strcmp(argv[1], "route") == 0) {
    dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
    dds_qset_deadline(qos, DDS_SECS(3));
    return subscribe(participant, &fathom_v1_Route_desc, "fathom/v1/route", qos, print_route);
  }
  publish_gps(participant, qos);
}
