/* What `ros2 node list` and `ros2 topic info` rest on. */
#include <string.h>

#include "ros2_peer.h"
#ifdef FATHOM_HUMBLE
#include "rmw_dds_common_humble.h"
#else
#include "rmw_dds_common.h"
#endif

static void print_hex(const char* name, const uint8_t* bytes, size_t count) {
  printf("%s ", name);
  for (size_t i = 0; i < count; ++i) printf("%02x", bytes[i]);
}

static void print_gid(const char* name, const rmw_dds_common_msg_dds__Gid_* gid) {
  print_hex(name, gid->data, 16);
  for (size_t i = 16; i < sizeof gid->data; ++i) {
    if (gid->data[i] != 0) printf(" not-zero");
  }
  printf("\n");
}

static void print_user_data(dds_qos_t* qos) {
  void* value = NULL;
  size_t size = 0;
  if (dds_qget_userdata(qos, &value, &size) && size > 0) printf(" %.*s", (int)size, (const char*)value);
  dds_free(value);
  printf("\n");
}

static void print_endpoints(dds_entity_t participant, dds_entity_t builtin, const char* name) {
  const dds_entity_t reader = dds_create_reader(participant, builtin, NULL, NULL);
  check(reader, "builtin reader");
  void* samples[128] = {NULL};
  dds_sample_info_t info[128];
  const dds_return_t taken = dds_read(reader, samples, info, 128, 128);
  check(taken, "read");
  for (dds_return_t i = 0; i < taken; ++i) {
    const dds_builtintopic_endpoint_t* one = samples[i];
    if (!info[i].valid_data) continue;
    print_hex(name, one->key.v, sizeof one->key.v);
    printf(" %s %s", one->topic_name, one->type_name);
    print_user_data(one->qos);
  }
}

static void print_participants(dds_entity_t participant) {
  const dds_entity_t reader = dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, NULL, NULL);
  check(reader, "builtin reader");
  void* samples[64] = {NULL};
  dds_sample_info_t info[64];
  const dds_return_t taken = dds_read(reader, samples, info, 64, 64);
  check(taken, "read");
  for (dds_return_t i = 0; i < taken; ++i) {
    const dds_builtintopic_participant_t* one = samples[i];
    if (!info[i].valid_data) continue;
    print_hex("discovered", one->key.v, sizeof one->key.v);
    print_user_data(one->qos);
  }
}

int print_graph(dds_entity_t participant) {
  const dds_entity_t topic = dds_create_topic(
      participant, &rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc, "ros_discovery_info", NULL, NULL);
  check(topic, "topic");
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
  const dds_entity_t reader = dds_create_reader(participant, topic, qos, NULL);
  check(reader, "reader");
  for (int i = 0; i < 2000; ++i) {
    void* samples[1] = {NULL};
    dds_sample_info_t info[1];
    const dds_return_t taken = dds_take(reader, samples, info, 1, 1);
    check(taken, "take");
    if (taken == 1 && info[0].valid_data) {
      dds_sleepfor(DDS_SECS(1)); /* the endpoints are discovered as well */
      const rmw_dds_common_msg_dds__ParticipantEntitiesInfo_* s = samples[0];
      print_gid("participant", &s->gid);
      for (uint32_t n = 0; n < s->node_entities_info_seq._length; ++n) {
        const rmw_dds_common_msg_dds__NodeEntitiesInfo_* node = &s->node_entities_info_seq._buffer[n];
        printf("node %s %s\n", node->node_namespace, node->node_name);
        for (uint32_t k = 0; k < node->reader_gid_seq._length; ++k)
          print_gid("reader", &node->reader_gid_seq._buffer[k]);
        for (uint32_t k = 0; k < node->writer_gid_seq._length; ++k)
          print_gid("writer", &node->writer_gid_seq._buffer[k]);
      }
      print_endpoints(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, "publication");
      print_endpoints(participant, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, "subscription");
      print_participants(participant);
      return 0;
    }
    dds_sleepfor(DDS_MSECS(10));
  }
  return 1;
}
