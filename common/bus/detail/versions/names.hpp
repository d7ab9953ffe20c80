#pragma once

// This folder is all that knows that Fast DDS and Fast CDR have versions: 2.9 (Debian 12, with which
// everything is measured), 2.11 (Ubuntu 24.04) and 3.1 (Debian 13). Here: what has another name or header in
// them.

#include <cstdint>

#if __has_include(<fastrtps/config.h>)
#include <fastrtps/config.h>
#define FATHOM_FASTDDS_MAJOR FASTRTPS_VERSION_MAJOR
#else
#include <fastdds/config.hpp>
#define FATHOM_FASTDDS_MAJOR FASTDDS_VERSION_MAJOR
#endif

#if FATHOM_FASTDDS_MAJOR < 3
#include <fastdds/rtps/common/Guid.h>
#include <fastdds/rtps/common/InstanceHandle.h>
#include <fastdds/rtps/common/Locator.h>
#include <fastdds/rtps/common/Time_t.h>
#include <fastdds/rtps/common/WriteParams.h>
#include <fastrtps/types/TypesBase.h>
#include <fastrtps/utils/IPLocator.h>
#else
#include <fastdds/dds/core/ReturnCode.hpp>
#include <fastdds/dds/core/Time_t.hpp>
#include <fastdds/rtps/common/Guid.hpp>
#include <fastdds/rtps/common/InstanceHandle.hpp>
#include <fastdds/rtps/common/Locator.hpp>
#include <fastdds/rtps/common/WriteParams.hpp>
#include <fastdds/utils/IPLocator.hpp>
#endif

// Only declared in the headers of everything above.
namespace eprosima::fastdds::dds {}

namespace fathom::bus::detail {

namespace dds = eprosima::fastdds::dds;

#if FATHOM_FASTDDS_MAJOR < 3
namespace rtps = eprosima::fastrtps::rtps;
using Duration = eprosima::fastrtps::Duration_t;
using ReturnCode = eprosima::fastrtps::types::ReturnCode_t;
inline const Duration& infinite_duration() {
  return eprosima::fastrtps::c_TimeInfinite;
}
/// What an operation of Fast DDS returned says that it was done. A writer's write() returns a bool until 3.0,
/// whose truth is the opposite of the code's.
inline bool done(const ReturnCode& code) {
  return code == ReturnCode::RETCODE_OK;
}
inline bool done(bool written) {
  return written;
}
#else
namespace rtps = eprosima::fastdds::rtps;
using Duration = dds::Duration_t;
using ReturnCode = dds::ReturnCode_t;
inline const Duration& infinite_duration() {
  return dds::c_TimeInfinite;
}
inline bool done(ReturnCode code) {
  return code == dds::RETCODE_OK;
}
#endif

}  // namespace fathom::bus::detail
