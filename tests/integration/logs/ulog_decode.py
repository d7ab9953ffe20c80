"""A second decoder of ULog, written for the tests alone: it shares nothing with common/logs and goes by the
specification in the plainest way, for files that are whole or cut, with appended data."""
import struct

TYPES = {"int8_t": "b", "uint8_t": "B", "int16_t": "h", "uint16_t": "H", "int32_t": "i", "uint32_t": "I",
         "int64_t": "q", "uint64_t": "Q", "float": "f", "double": "d", "bool": "?", "char": "c"}


def flat(formats, name, prefix=""):
    """(column, code) of every element in the order of the bytes; column None for what is no number."""
    out = []
    for kind, count, field in formats[name]:
        for i in range(count or 1):
            label = prefix + field + (f"[{i}]" if count else "")
            if kind in TYPES:
                hidden = field.startswith("_padding") or kind == "char"
                out.append((None if hidden else label, TYPES[kind]))
            else:
                out.extend(flat(formats, kind, label + "."))
    return out


def decode(blob):
    """{(topic, instance): (columns, rows)}"""
    assert blob[:7] == b"\x55\x4c\x6f\x67\x01\x12\x35"
    cuts = []
    size, kind = struct.unpack_from("<HB", blob, 16)
    if kind == ord("B") and blob[16 + 3 + 8] & 1:
        cuts = [o for o in struct.unpack_from("<3Q", blob, 16 + 3 + 16) if o and o < len(blob)]
    formats, ids, out = {}, {}, {}
    begin = 16
    for end in cuts + [len(blob)]:
        at = begin
        while at + 3 <= end:
            size, kind = struct.unpack_from("<HB", blob, at)
            if at + 3 + size > end:
                break
            body = blob[at + 3:at + 3 + size]
            at += 3 + size
            if kind == ord("F"):
                name, fields = body.decode().split(":", 1)
                formats[name] = []
                for one in filter(None, fields.split(";")):
                    what, field = one.split(" ")
                    what, _, count = what.partition("[")
                    formats[name].append((what, int(count[:-1]) if count else 0, field))
            elif kind == ord("A"):
                multi, number = struct.unpack_from("<BH", body)
                topic = body[3:].decode()
                layout = flat(formats, topic)
                ids[number] = (topic, multi, layout)
                out.setdefault((topic, multi), ([c for c, _ in layout if c], []))
            elif kind == ord("D"):
                number, = struct.unpack_from("<H", body)
                topic, multi, layout = ids[number]
                codes = "<" + "".join(code for _, code in layout)
                body = body[2:].ljust(struct.calcsize(codes), b"\0")
                values = struct.unpack_from(codes, body)
                row = {c: float(v) for (c, _), v in zip(layout, values) if c}
                out[(topic, multi)][1].append(row)
        begin = end
    return out
