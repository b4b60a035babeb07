// Unpacks LZMA ("LZMA alone": properties, dictionary size, length, data), which packs the evaluator a third smaller than
// the gzip that browsers know. After the description of the format in the LZMA specification by Igor Pavlov (2015).

const LENGTHS = 4;

/** The range decoder: bits by adaptive probabilities. */
class Bits {
  private range = 0xffffffff;
  private code = 0;

  constructor(
    private readonly bytes: Uint8Array,
    private at: number,
  ) {
    this.at += 1;
    for (let i = 0; i < 4; i++) this.code = ((this.code << 8) | this.next()) >>> 0;
  }

  bit(probabilities: Uint16Array, index: number): 0 | 1 {
    const probability = probabilities[index]!;
    const bound = (this.range >>> 11) * probability;
    let bit: 0 | 1;
    if (this.code < bound) {
      this.range = bound;
      probabilities[index] = probability + ((2048 - probability) >> 5);
      bit = 0;
    } else {
      this.range -= bound;
      this.code -= bound;
      probabilities[index] = probability - (probability >> 5);
      bit = 1;
    }
    if (this.range < 0x1000000) {
      this.range = (this.range << 8) >>> 0;
      this.code = ((this.code << 8) | this.next()) >>> 0;
    }
    return bit;
  }

  /** Bits that are as likely 0 as 1. */
  direct(count: number): number {
    let value = 0;
    for (let i = 0; i < count; i++) {
      this.range >>>= 1;
      const bit = this.code >= this.range ? 1 : 0;
      if (bit === 1) this.code -= this.range;
      if (this.range < 0x1000000) {
        this.range = (this.range << 8) >>> 0;
        this.code = ((this.code << 8) | this.next()) >>> 0;
      }
      value = value * 2 + bit;
    }
    return value;
  }

  /** A number of so many bits, the greatest first. */
  tree(probabilities: Uint16Array, start: number, bits: number): number {
    let m = 1;
    for (let i = 0; i < bits; i++) m = (m << 1) | this.bit(probabilities, start + m);
    return m - (1 << bits);
  }

  /** The same, the least bit first. */
  reversed(probabilities: Uint16Array, start: number, bits: number): number {
    let m = 1;
    let value = 0;
    for (let i = 0; i < bits; i++) {
      const bit = this.bit(probabilities, start + m);
      m = (m << 1) | bit;
      value |= bit << i;
    }
    return value;
  }

  private next(): number {
    return this.bytes[this.at++] ?? 0;
  }
}

/** The lengths of matches. */
class Lengths {
  private readonly choice = even(2);
  private readonly low = even(16 << 3);
  private readonly middle = even(16 << 3);
  private readonly high = even(256);

  read(bits: Bits, state: number): number {
    if (bits.bit(this.choice, 0) === 0) return bits.tree(this.low, state << 3, 3);
    if (bits.bit(this.choice, 1) === 0) return 8 + bits.tree(this.middle, state << 3, 3);
    return 16 + bits.tree(this.high, 0, 8);
  }
}

function even(count: number): Uint16Array {
  return new Uint16Array(count).fill(1024);
}

/** The bytes that were packed. */
export function unpack(packed: Uint8Array): Uint8Array<ArrayBuffer> {
  const head = new DataView(packed.buffer, packed.byteOffset, 13);
  const properties = head.getUint8(0);
  const lc = properties % 9;
  const lp = Math.floor(properties / 9) % 5;
  const pb = Math.floor(properties / 45);
  const out = new Uint8Array(head.getUint32(5, true));
  const bits = new Bits(packed, 13);
  const literals = even(0x300 << (lc + lp));
  const [isMatch, isRep, isRep0, isRep1, isRep2, isRep0Long] = [even(192), even(12), even(12), even(12), even(12), even(192)];
  const slots = even(LENGTHS << 6);
  const special = even(128);
  const align = even(16);
  const [matches, repeats] = [new Lengths(), new Lengths()];
  let [rep0, rep1, rep2, rep3] = [0, 0, 0, 0];
  let state = 0;
  let at = 0;
  while (at < out.length) {
    const place = at & ((1 << pb) - 1);
    if (bits.bit(isMatch, (state << 4) + place) === 0) {
      const before = at > 0 ? out[at - 1]! : 0;
      const start = 0x300 * (((at & ((1 << lp) - 1)) << lc) + (before >> (8 - lc)));
      let symbol = 1;
      if (state >= 7) {
        // After a match: the byte that would follow it is likely wrong in one bit only.
        let match = out[at - rep0 - 1]!;
        while (symbol < 0x100) {
          const likely = (match >> 7) & 1;
          match <<= 1;
          const bit = bits.bit(literals, start + ((1 + likely) << 8) + symbol);
          symbol = (symbol << 1) | bit;
          if (likely !== bit) break;
        }
      }
      while (symbol < 0x100) symbol = (symbol << 1) | bits.bit(literals, start + symbol);
      out[at++] = symbol & 0xff;
      state = state < 4 ? 0 : state < 10 ? state - 3 : state - 6;
      continue;
    }
    let length: number;
    if (bits.bit(isRep, state) === 1) {
      if (bits.bit(isRep0, state) === 0) {
        if (bits.bit(isRep0Long, (state << 4) + place) === 0) {
          state = state < 7 ? 9 : 11;
          out[at] = out[at - rep0 - 1]!;
          at += 1;
          continue;
        }
      } else {
        let distance: number;
        if (bits.bit(isRep1, state) === 0) distance = rep1;
        else {
          if (bits.bit(isRep2, state) === 0) distance = rep2;
          else {
            distance = rep3;
            rep3 = rep2;
          }
          rep2 = rep1;
        }
        rep1 = rep0;
        rep0 = distance;
      }
      length = repeats.read(bits, place);
      state = state < 7 ? 8 : 11;
    } else {
      [rep3, rep2, rep1] = [rep2, rep1, rep0];
      length = matches.read(bits, place);
      state = state < 7 ? 7 : 10;
      const slot = bits.tree(slots, Math.min(length, LENGTHS - 1) << 6, 6);
      rep0 = slot;
      if (slot >= 4) {
        const count = (slot >> 1) - 1;
        rep0 = (2 | (slot & 1)) * 2 ** count;
        if (slot < 14) rep0 += bits.reversed(special, rep0 - slot, count);
        else rep0 += bits.direct(count - 4) * 16 + bits.reversed(align, 0, 4);
      }
      if (rep0 === 0xffffffff) break;
    }
    length += 2;
    if (rep0 >= at) throw new Error("the evaluator is damaged");
    const end = Math.min(at + length, out.length);
    for (; at < end; at++) out[at] = out[at - rep0 - 1]!;
  }
  return out;
}
