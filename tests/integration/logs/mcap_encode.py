"""A writer of MCAP and an encoder of CDR for the tests alone: they share nothing with common/record and common/logs.
The definitions are those of ROS 2's standard messages, with their fields as ros2 interface show lists them."""
import ctypes
import ctypes.util
import struct
import zlib

TIME = "int32 sec\nuint32 nanosec\n"
HEADER = "# Standard header\nbuiltin_interfaces/Time stamp\n\n# Transform frame with which this data is associated.\nstring frame_id\n"
VECTOR3 = "float64 x\nfloat64 y\nfloat64 z\n"
POINT = VECTOR3
QUATERNION = "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"
TWIST = "Vector3  linear\nVector3  angular\n"
POSE = "Point position\nQuaternion orientation\n"
DEFINITIONS = {
    "builtin_interfaces/Time": TIME,
    "std_msgs/Header": HEADER,
    "geometry_msgs/Vector3": VECTOR3,
    "geometry_msgs/Point": POINT,
    "geometry_msgs/Quaternion": QUATERNION,
    "geometry_msgs/Twist": TWIST,
    "geometry_msgs/Pose": POSE,
    "geometry_msgs/Transform": "Vector3 translation\nQuaternion rotation\n",
    "geometry_msgs/TransformStamped": "std_msgs/Header header\nstring child_frame_id\nTransform transform\n",
    "geometry_msgs/TwistStamped": "std_msgs/Header header\nTwist twist\n",
    "geometry_msgs/TwistWithCovariance": "Twist twist\n\n# Row-major 6x6\nfloat64[36] covariance\n",
    "geometry_msgs/TwistWithCovarianceStamped": "std_msgs/Header header\nTwistWithCovariance twist\n",
    "geometry_msgs/PoseWithCovariance": "Pose pose\nfloat64[36] covariance\n",
    "nav_msgs/Odometry": "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
                         "geometry_msgs/TwistWithCovariance twist\n",
    "sensor_msgs/Imu": "# -1 in the first element: not measured\nstd_msgs/Header header\n\n"
                       "geometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance # row major\n\n"
                       "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n\n"
                       "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n",
    "sensor_msgs/NavSatStatus": "int8 STATUS_NO_FIX =  -1\nint8 STATUS_FIX =      0\nint8 STATUS_SBAS_FIX = 1\n"
                                "int8 STATUS_GBAS_FIX = 2\nint8 status -2 # STATUS_UNKNOWN\n\nuint16 SERVICE_GPS = 1\n"
                                "uint16 service\n",
    "sensor_msgs/NavSatFix": "std_msgs/Header header\nsensor_msgs/NavSatStatus status\nfloat64 latitude\n"
                             "float64 longitude\nfloat64 altitude\nfloat64[9] position_covariance\n"
                             "uint8 COVARIANCE_TYPE_UNKNOWN = 0\nuint8 COVARIANCE_TYPE_KNOWN = 3\n"
                             "uint8 position_covariance_type\n",
    "sensor_msgs/FluidPressure": "std_msgs/Header header\nfloat64 fluid_pressure # Pascals\nfloat64 variance\n",
    "sensor_msgs/MagneticField": "std_msgs/Header header\ngeometry_msgs/Vector3 magnetic_field\n"
                                 "float64[9] magnetic_field_covariance\n",
    "tf2_msgs/TFMessage": "geometry_msgs/TransformStamped[] transforms\n",
    "std_msgs/String": "string data\n",
    # A driver of Water Linked's instruments.
    "dvl_msgs/DVLBeam": "int64 id\nfloat64 velocity\nfloat64 distance\nfloat64 rssi\nfloat64 nsd\nbool valid\n",
    "dvl_msgs/DVL": "std_msgs/Header header\nfloat64 time\ngeometry_msgs/Vector3 velocity\nfloat64 fom\n"
                    "float64 altitude\nDVLBeam[] beams\nbool velocity_valid\nint64 status\nstring form\n",
    # Of the underwater community.
    "marine_acoustic_msgs/Dvl": "uint8 DVL_MODE_BOTTOM=1\nuint8 DVL_MODE_WATER=2\nstd_msgs/Header header\n"
                                "uint8 velocity_mode\nuint8 dvl_type\ngeometry_msgs/Vector3 velocity\n"
                                "float64[9] velocity_covar\nfloat64 altitude\nfloat64 course_gnd\nfloat64 speed_gnd\n"
                                "uint8 num_good_beams\nfloat32 sound_speed\nbool beam_ranges_valid\n"
                                "bool beam_velocities_valid\ngeometry_msgs/Vector3[4] beam_unit_vec\nfloat64[4] range\n"
                                "float32[4] range_covar\nfloat32[4] beam_quality\nfloat32[4] beam_velocity\n"
                                "float32[4] beam_velocity_covar\n",
    # After UUV Simulator.
    "uuv_msgs/DVLBeam": "float64 range\nfloat64 range_covariance\nfloat64 velocity\nfloat64 velocity_covariance\n"
                        "geometry_msgs/Pose pose\n",
    "uuv_msgs/DVL": "std_msgs/Header header\ngeometry_msgs/Vector3 velocity\nfloat64[9] velocity_covariance\n"
                    "float64 altitude\nuuv_msgs/DVLBeam[] beams\n",
}
CODES = {"bool": "?", "byte": "B", "char": "B", "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i",
         "uint32": "I", "int64": "q", "uint64": "Q", "float32": "f", "float64": "d"}


def fields(kind):
    """(type, array, name) of a definition's lines."""
    out = []
    for line in DEFINITIONS[kind].splitlines():
        line = line.split("#")[0].strip()
        if not line or "=" in line.replace("<=", ""):
            continue
        what, name = line.split()[:2]
        array = None
        if what.endswith("]"):
            what, _, array = what[:-1].partition("[")
        if what not in CODES and what != "string" and "/" not in what:
            what = kind.split("/")[0] + "/" + what
        out.append((what, array, name))
    return out


def schema_text(kind):
    """The definition and, behind separators, those that it needs: as rosbag2 writes them."""
    needed, todo = [], [kind]
    while todo:
        for what, _, _ in fields(todo.pop()):
            if what in DEFINITIONS and what not in needed:
                needed.append(what)
                todo.append(what)
    return "".join([DEFINITIONS[kind]] + ["=" * 80 + f"\nMSG: {one}\n" + DEFINITIONS[one] for one in sorted(needed)])


class Cdr:
    def __init__(self, little=True):
        self.order = "<" if little else ">"
        self.body = b""
        self.little = little

    def put(self, code, value):
        size = struct.calcsize("<" + code)
        self.body += b"\0" * (-len(self.body) % size) + struct.pack(self.order + code, value)

    def value(self, kind, value):
        if kind == "string":
            text = value.encode() + b"\0"
            self.put("I", len(text))
            self.body += text
        elif kind in CODES:
            self.put(CODES[kind], value)
        else:
            for what, array, name in fields(kind):
                one = value.get(name, default(what, array))
                if array is None:
                    self.value(what, one)
                    continue
                if array == "" or array.startswith("<="):
                    self.put("I", len(one))
                else:
                    assert len(one) == int(array), (kind, name, len(one))
                for element in one:
                    self.value(what, element)

    def bytes(self):
        return (b"\0\1\0\0" if self.little else b"\0\0\0\0") + self.body + b"\0" * (-len(self.body) % 4)


def default(what, array):
    one = "" if what == "string" else 0 if what in CODES else {}
    if array is None:
        return one
    return [] if array == "" or array.startswith("<=") else [one] * int(array)


def cdr(kind, value, little=True):
    out = Cdr(little)
    out.value(kind, value)
    return out.bytes()


def stamp(t_ns):
    return {"sec": t_ns // 10**9, "nanosec": t_ns % 10**9}


def pack(compression, data):
    if compression == "zstd":
        lib = ctypes.CDLL(ctypes.util.find_library("zstd"))
        lib.ZSTD_compressBound.restype = lib.ZSTD_compress.restype = ctypes.c_size_t
        room = ctypes.create_string_buffer(lib.ZSTD_compressBound(ctypes.c_size_t(len(data))))
        size = lib.ZSTD_compress(room, ctypes.c_size_t(len(room)), data, ctypes.c_size_t(len(data)), 3)
        return room.raw[:size]
    if compression == "lz4":
        lib = ctypes.CDLL(ctypes.util.find_library("lz4"))
        lib.LZ4F_compressFrameBound.restype = lib.LZ4F_compressFrame.restype = ctypes.c_size_t
        room = ctypes.create_string_buffer(lib.LZ4F_compressFrameBound(ctypes.c_size_t(len(data)), None))
        size = lib.LZ4F_compressFrame(room, ctypes.c_size_t(len(room)), data, ctypes.c_size_t(len(data)), None)
        return room.raw[:size]
    return data


def text(s):
    data = s.encode()
    return struct.pack("<I", len(data)) + data


def record(op, content):
    return struct.pack("<BQ", op, len(content)) + content


MAGIC = b"\x89MCAP0\r\n"


class Bag:
    """Messages in the order that they are added; bytes() makes the file."""

    def __init__(self):
        self.schemas = {}    # (name, text): id
        self.channels = {}   # (topic, schema id): id
        self.messages = []   # (channel, log time, data)

    def channel(self, topic, kind, definition=None, encoding="ros2msg", message_encoding="cdr"):
        package, name = kind.split("/")
        key = (f"{package}/msg/{name}", schema_text(kind) if definition is None else definition, encoding)
        schema = self.schemas.setdefault(key, len(self.schemas) + 1)
        return self.channels.setdefault((topic, schema, message_encoding), len(self.channels) + 1)

    def add(self, topic, kind, log_ns, value, little=True):
        self.raw(self.channel(topic, kind), log_ns, cdr(kind, value, little))

    def raw(self, channel, log_ns, data):
        self.messages.append((channel, log_ns, data))

    def bytes(self, compression="", chunk=100, summary=True, chunked=True):
        described = b""
        for (name, definition, encoding), number in self.schemas.items():
            described += record(3, struct.pack("<H", number) + text(name) + text(encoding) + text(definition))
        for (topic, schema, encoding), number in self.channels.items():
            described += record(4, struct.pack("<HH", number, schema) + text(topic) + text(encoding) +
                                struct.pack("<I", 0))
        out = MAGIC + record(1, text("ros2") + text("the test's own"))
        indexes, counts = b"", {}
        one = [record(5, struct.pack("<HIQQ", c, i, t, t) + data) for i, (c, t, data) in enumerate(self.messages)]
        for c, _, _ in self.messages:
            counts[c] = counts.get(c, 0) + 1
        if not chunked:
            out += described + b"".join(one)
        for begin in range(0, len(one), chunk) if chunked else ():
            inside = (described if begin == 0 else b"") + b"".join(one[begin:begin + chunk])
            times = [t for _, t, _ in self.messages[begin:begin + chunk]]
            packed = pack(compression, inside)
            at = len(out)
            out += record(6, struct.pack("<QQQI", min(times), max(times), len(inside), zlib.crc32(inside)) +
                          text(compression) + struct.pack("<Q", len(packed)) + packed)
            length = len(out) - at
            own, offset = {}, len(described) if begin == 0 else 0
            for (c, t, _), r in zip(self.messages[begin:begin + chunk], one[begin:begin + chunk]):
                own.setdefault(c, []).append((t, offset))
                offset += len(r)
            places, after = b"", len(out)
            for c, entries in own.items():
                places += struct.pack("<HQ", c, len(out))
                out += record(7, struct.pack("<HI", c, 16 * len(entries)) +
                              b"".join(struct.pack("<QQ", *e) for e in entries))
            indexes += record(8, struct.pack("<QQQQI", min(times), max(times), at, length, len(places)) + places +
                              struct.pack("<Q", len(out) - after) + text(compression) +
                              struct.pack("<QQ", len(packed), len(inside)))
        out += record(15, struct.pack("<I", 0))
        if not summary:
            return out + record(2, struct.pack("<QQI", 0, 0, 0)) + MAGIC
        times = [t for _, t, _ in self.messages] or [0]
        start = len(out)
        out += described + indexes
        out += record(11, struct.pack("<QHIIIIQQI", len(one), len(self.schemas), len(self.channels), 0, 0,
                                      -(-len(one) // chunk) if chunked else 0, min(times), max(times),
                                      10 * len(counts)) +
                      b"".join(struct.pack("<HQ", c, n) for c, n in counts.items()))
        return out + record(2, struct.pack("<QQI", start, 0, 0)) + MAGIC
