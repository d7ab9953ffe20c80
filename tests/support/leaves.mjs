// The values of a decoded message as texts, appended to `out`: doubles by their bits, as support/leaves.hpp writes them.
const bits = new DataView(new ArrayBuffer(8));
export function leaves(value, field, definitions, out) {
  if (Array.isArray(value) || ArrayBuffer.isView(value)) {
    if (field.arrayLengths === undefined) out.push(String(value.length));
    for (const one of value) leaves(one, { ...field, isArray: false }, definitions, out);
  } else if (field.isComplex) {
    const definition = definitions.get(field.type);
    for (const inner of definition.definitions) leaves(value[inner.name], inner, definitions, out);
  } else if (field.type === "float64") {
    bits.setFloat64(0, value);
    out.push(Number.isNaN(value) ? "nan" : bits.getBigUint64(0).toString());
  } else if (typeof value === "string") {
    out.push(`'${value}'`);
  } else {
    out.push(String(Number.isInteger(value) || typeof value === "bigint" ? value : Number(value)));
  }
}
