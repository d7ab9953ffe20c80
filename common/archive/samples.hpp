#pragma once

#include "archive/samples/actuator.hpp"
#include "archive/samples/airspeed.hpp"
#include "archive/samples/command.hpp"
#include "archive/samples/depth.hpp"
#include "archive/samples/dvl.hpp"
#include "archive/samples/fix.hpp"
#include "archive/samples/gps.hpp"
#include "archive/samples/header.hpp"
#include "archive/samples/heading.hpp"
#include "archive/samples/range.hpp"
#include "archive/samples/usbl.hpp"

/// Fields of the samples. Their numbers may be any: a sample out of an archive is judged when it acts, as one
/// that has just come from the network.
