// SPDX-License-Identifier: MIT
//
// png.js - writes PNG files of 16 bits a sample, which a canvas cannot write.

const CRC = Uint32Array.from({length: 256}, (unused, n) => {
    for (let bit = 0; bit < 8; bit++)
        n = n & 1 ? 0xedb88320 ^ n >>> 1 : n >>> 1;
    return n;
});

// Returns a chunk: length, TYPE, DATA, CRC of the last two.
function makeChunk(type, data) {
    const chunk = new Uint8Array(12 + data.length), view = new DataView(chunk.buffer);
    let crc = ~0;
    view.setUint32(0, data.length);
    chunk.set(new TextEncoder().encode(type), 4);
    chunk.set(data, 8);
    for (let i = 4; i < 8 + data.length; i++)
        crc = CRC[(crc ^ chunk[i]) & 255] ^ crc >>> 8;
    view.setUint32(8 + data.length, ~crc);
    return chunk;
}

// Returns a file of SAMPLES, R G B or R G B A of 16 bits, high byte first.
export async function encodePng(samples, width, height) {
    const row = samples.length / height, step = row / width, head = new Uint8Array(13), view = new DataView(head.buffer);
    view.setUint32(0, width);
    view.setUint32(4, height);
    head.set([16, step === 8 ? 6 : 2], 8);
    const filtered = new Uint8Array(samples.length + height);
    for (let y = 0; y < height; y++) { // filter 1: differences from the pixel to the left
        const from = y * row, to = from + y + 1;
        filtered[to - 1] = 1;
        for (let i = 0; i < row; i++)
            filtered[to + i] = samples[from + i] - (i < step ? 0 : samples[from + i - step]);
    }
    const packed = await new Response(new Blob([filtered]).stream().pipeThrough(new CompressionStream("deflate"))).arrayBuffer();
    return new Blob([new Uint8Array([137, 80, 78, 71, 13, 10, 26, 10]), makeChunk("IHDR", head), makeChunk("IDAT", new Uint8Array(packed)),
        makeChunk("IEND", new Uint8Array(0))], {type: "image/png"});
}
