/* ros2_peer ROLE DOMAIN [TYPE TOPIC [TOPIC]]: a Cyclone DDS participant for the tests, as a node of ROS 2
 * would be. graph: prints the graph. echo TYPE IN OUT: writes to OUT what it reads from IN until it is
 * killed. read TYPE TOPIC [latched|besteffort]: prints the first message received, one "field values" a line.
 * follow TYPE TOPIC: prints a line for each until it is killed.
 * write TYPE TOPIC [TEXT]: publishes a message of an instrument every 20 ms with the time of the host until
 * it is killed; TEXT is that of a string. Exits 1 after 20 s without a message. */
#include "ros2_peer.h"

#include <string.h>

#include "diagnostic_msgs.h"
#include "geographic_msgs.h"
#include "marine_acoustic_msgs.h"
#include "nav_msgs.h"
#include "sensor_msgs.h"
#include "std_msgs.h"
#include "tf2_msgs.h"

static void values(const char* name, const double* v, size_t n) {
  printf("%s", name);
  for (size_t i = 0; i < n; ++i) printf(" %.17g", v[i]);
  printf("\n");
}
static void header(const std_msgs_msg_dds__Header_* h) {
  printf("stamp %d %u\nframe_id %s\n", (int)h->stamp.sec, (unsigned)h->stamp.nanosec, h->frame_id);
}
static void vector(const char* name, const geometry_msgs_msg_dds__Vector3_* v) {
  values(name, &v->x, 3);
}
static void pose(const geometry_msgs_msg_dds__PoseWithCovariance_* p) {
  values("position", &p->pose.position.x, 3);
  values("orientation", &p->pose.orientation.x, 4);
  values("pose_covariance", p->covariance, 36);
}
static void twist(const geometry_msgs_msg_dds__TwistWithCovariance_* t) {
  vector("linear", &t->twist.linear);
  vector("angular", &t->twist.angular);
  values("twist_covariance", t->covariance, 36);
}

static void print_odometry(const void* data) {
  const nav_msgs_msg_dds__Odometry_* m = data;
  header(&m->header);
  printf("child_frame_id %s\n", m->child_frame_id);
  pose(&m->pose);
  twist(&m->twist);
}
static void print_imu(const void* data) {
  const sensor_msgs_msg_dds__Imu_* m = data;
  header(&m->header);
  values("orientation", &m->orientation.x, 4);
  values("orientation_covariance", m->orientation_covariance, 9);
  vector("angular_velocity", &m->angular_velocity);
  values("angular_velocity_covariance", m->angular_velocity_covariance, 9);
  vector("linear_acceleration", &m->linear_acceleration);
  values("linear_acceleration_covariance", m->linear_acceleration_covariance, 9);
}
static void print_fix(const void* data) {
  const sensor_msgs_msg_dds__NavSatFix_* m = data;
  header(&m->header);
  printf("status %d %u\n", (int)m->status.status, (unsigned)m->status.service);
  values("latitude", &m->latitude, 3);
  values("position_covariance", m->position_covariance, 9);
  printf("position_covariance_type %u\n", (unsigned)m->position_covariance_type);
}
static void print_twist(const void* data) {
  const geometry_msgs_msg_dds__TwistWithCovarianceStamped_* m = data;
  header(&m->header);
  twist(&m->twist);
}
static void print_pose(const void* data) {
  const geometry_msgs_msg_dds__PoseWithCovarianceStamped_* m = data;
  header(&m->header);
  pose(&m->pose);
}
static void print_geopose(const void* data) {
  const geographic_msgs_msg_dds__GeoPoseStamped_* m = data;
  header(&m->header);
  values("latitude", &m->pose.position.latitude, 3);
  values("orientation", &m->pose.orientation.x, 4);
}
static void print_tf(const void* data) {
  const tf2_msgs_msg_dds__TFMessage_* m = data;
  for (uint32_t i = 0; i < m->transforms._length; ++i) {
    const geometry_msgs_msg_dds__TransformStamped_* t = &m->transforms._buffer[i];
    printf("transform %s %s %d %u", t->header.frame_id, t->child_frame_id, (int)t->header.stamp.sec,
           (unsigned)t->header.stamp.nanosec);
    const double* v = &t->transform.translation.x;
    const double* q = &t->transform.rotation.x;
    printf(" %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", v[0], v[1], v[2], q[0], q[1], q[2], q[3]);
  }
}
static void print_diagnostics(const void* data) {
  const diagnostic_msgs_msg_dds__DiagnosticArray_* m = data;
  header(&m->header);
  for (uint32_t i = 0; i < m->status._length; ++i) {
    const diagnostic_msgs_msg_dds__DiagnosticStatus_* s = &m->status._buffer[i];
    printf("status %u '%s' '%s' '%s' %u values\n", (unsigned)s->level, s->name, s->message, s->hardware_id,
           (unsigned)s->values._length);
  }
}

static std_msgs_msg_dds__Header_ header_now(const char* frame) {
  const dds_time_t now = dds_time();
  std_msgs_msg_dds__Header_ h;
  h.stamp.sec = (int32_t)(now / DDS_NSECS_IN_SEC);
  h.stamp.nanosec = (uint32_t)(now % DDS_NSECS_IN_SEC);
  h.frame_id = (char*)(uintptr_t)frame;
  return h;
}
static void fill_imu(void* data) {
  sensor_msgs_msg_dds__Imu_* m = data;
  m->header = header_now("imu_link");
  m->angular_velocity.x = 0.1;
  m->angular_velocity.y = 0.2;
  m->angular_velocity.z = 0.3;
  m->linear_acceleration.x = 0.5;
  m->linear_acceleration.y = 0.6;
  m->linear_acceleration.z = 9.81;
}
static void fill_fix(void* data) {
  sensor_msgs_msg_dds__NavSatFix_* m = data;
  m->header = header_now("gps_link");
  m->status.service = 1;
  m->latitude = -33.5;
  m->longitude = 151.25;
  m->altitude = 21.0;
  m->position_covariance[0] = 4.0;
  m->position_covariance[4] = 9.0;
  m->position_covariance[8] = 25.0;
  m->position_covariance_type = 2;
}
static void fill_pressure(void* data) {
  sensor_msgs_msg_dds__FluidPressure_* m = data;
  m->header = header_now("depth_link");
  m->fluid_pressure = 1101325.0;
  m->variance = 1e4;
}
static void fill_dvl(void* data) {
  marine_acoustic_msgs_msg_dds__Dvl_* m = data;
  m->header = header_now("dvl_link");
  m->velocity_mode = 1;
  m->velocity.x = 1.0;
  m->velocity.y = 0.25;
  m->velocity.z = 0.125;
  for (int i = 0; i < 9; ++i) m->velocity_covar[i] = -1.0;
  m->altitude = 12.5;
  m->num_good_beams = 4;
  m->sound_speed = 1500.0F;
  m->beam_ranges_valid = true;
  for (int i = 0; i < 4; ++i) m->range[i] = 14.0 + i;
}
static void fill_twist(void* data) {
  geometry_msgs_msg_dds__TwistWithCovarianceStamped_* m = data;
  m->header = header_now("log_link");
  m->twist.twist.linear.x = 1.5;
  m->twist.twist.linear.y = -0.25;
  m->twist.twist.linear.z = 0.5;
  m->twist.covariance[0] = m->twist.covariance[7] = m->twist.covariance[14] = 0.04;
}

static void fill_pose(void* data) {
  geometry_msgs_msg_dds__PoseWithCovarianceStamped_* m = data;
  m->header = header_now("map");
  m->pose.pose.position.x = 300.0;
  m->pose.pose.position.y = 400.0;
  m->pose.pose.orientation.w = 1.0;
  m->pose.covariance[0] = 25.0;
  m->pose.covariance[7] = 100.0;
}
static const char* said = "";
static void fill_string(void* data) {
  std_msgs_msg_dds__String_* m = data;
  m->data = (char*)(uintptr_t)said;
}
static void print_string(const void* data) {
  const std_msgs_msg_dds__String_* m = data;
  printf("data %s\n", m->data);
}

struct type {
  const char* name;
  const dds_topic_descriptor_t* descriptor;
  void (*print)(const void*);
  void (*fill)(void*);
};
static const struct type kTypes[] = {
    {"odometry", &nav_msgs_msg_dds__Odometry__desc, print_odometry, NULL},
    {"imu", &sensor_msgs_msg_dds__Imu__desc, print_imu, fill_imu},
    {"fix", &sensor_msgs_msg_dds__NavSatFix__desc, print_fix, fill_fix},
    {"pressure", &sensor_msgs_msg_dds__FluidPressure__desc, NULL, fill_pressure},
    {"dvl", &marine_acoustic_msgs_msg_dds__Dvl__desc, NULL, fill_dvl},
    {"twist", &geometry_msgs_msg_dds__TwistWithCovarianceStamped__desc, print_twist, fill_twist},
    {"pose", &geometry_msgs_msg_dds__PoseWithCovarianceStamped__desc, print_pose, fill_pose},
    {"geopose", &geographic_msgs_msg_dds__GeoPoseStamped__desc, print_geopose, NULL},
    {"tf", &tf2_msgs_msg_dds__TFMessage__desc, print_tf, NULL},
    {"string", &std_msgs_msg_dds__String__desc, print_string, fill_string},
    {"diagnostics", &diagnostic_msgs_msg_dds__DiagnosticArray__desc, print_diagnostics, NULL},
};

static const struct type* find_type(const char* name) {
  for (size_t i = 0; i < sizeof kTypes / sizeof kTypes[0]; ++i) {
    if (strcmp(kTypes[i].name, name) == 0) return &kTypes[i];
  }
  fprintf(stderr, "ros2_peer: no type %s\n", name);
  exit(2);
}

static dds_entity_t reader_of(dds_entity_t participant, const struct type* type, const char* topic,
                              dds_qos_t* qos) {
  const dds_entity_t t = dds_create_topic(participant, type->descriptor, topic, NULL, NULL);
  check(t, "topic");
  const dds_entity_t reader = dds_create_reader(participant, t, qos, NULL);
  check(reader, "reader");
  return reader;
}
static dds_entity_t writer_of(dds_entity_t participant, const struct type* type, const char* topic,
                              dds_qos_t* qos) {
  const dds_entity_t t = dds_create_topic(participant, type->descriptor, topic, NULL, NULL);
  check(t, "topic");
  const dds_entity_t writer = dds_create_writer(participant, t, qos, NULL);
  check(writer, "writer");
  return writer;
}

/* Calls `with` for each message; ends after the first where `once`. */
static int each(dds_entity_t reader, int once, void (*with)(const void*), dds_entity_t echo) {
  for (int idle = 0; idle < 20000; ++idle) {
    void* samples[1] = {NULL};
    dds_sample_info_t info[1];
    const dds_return_t taken = dds_take(reader, samples, info, 1, 1);
    check(taken, "take");
    if (taken == 1 && info[0].valid_data) {
      if (with != NULL) with(samples[0]);
      if (echo > 0) check(dds_write(echo, samples[0]), "write");
      fflush(stdout);
      if (once) return 0;
      idle = 0;
    }
    if (taken > 0) check(dds_return_loan(reader, samples, taken), "return loan");
    if (taken == 0) dds_sleepfor(DDS_MSECS(1));
  }
  return 1;
}

int main(int argc, char** argv) {
  if (argc < 3) {
    fprintf(stderr, "usage: ros2_peer graph|echo|read|follow|write DOMAIN [TYPE TOPIC [TOPIC|latched]]\n");
    return 2;
  }
  const dds_entity_t participant =
      dds_create_participant((dds_domainid_t)strtoul(argv[2], NULL, 10), NULL, NULL);
  check(participant, "participant");
  if (strcmp(argv[1], "graph") == 0) return print_graph(participant);
  if (argc < 5) return 2;
  const struct type* type = find_type(argv[3]);
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 10);
  if (argc == 6 && strcmp(argv[5], "latched") == 0) dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  if (argc == 6 && strcmp(argv[5], "besteffort") == 0)
    dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0);
  if (strcmp(argv[1], "read") == 0)
    return each(reader_of(participant, type, argv[4], qos), 1, type->print, 0);
  if (strcmp(argv[1], "follow") == 0)
    return each(reader_of(participant, type, argv[4], qos), 0, type->print, 0);
  if (strcmp(argv[1], "echo") == 0 && argc == 6) {
    const dds_entity_t writer = writer_of(participant, type, argv[5], qos);
    return each(reader_of(participant, type, argv[4], qos), 0, NULL, writer);
  }
  if (strcmp(argv[1], "write") != 0 || type->fill == NULL) return 2;
  if (argc == 6) said = argv[5];
  const dds_entity_t writer = writer_of(participant, type, argv[4], qos);
  void* message = calloc(1, type->descriptor->m_size);
  for (;;) {
    type->fill(message);
    check(dds_write(writer, message), "write");
    dds_sleepfor(DDS_MSECS(20));
  }
}
