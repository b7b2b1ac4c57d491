// SPDX-License-Identifier: MIT
//
// jpeg.js - copies the metadata of a photograph to a JPEG file.

// Returns [start, end] of each segment between the start of the file and its picture.
function segments(bytes) {
    const list = [];
    for (let at = 2; bytes[at] === 0xff && bytes[at + 1] !== 0xda && at + 4 <= bytes.length;) {
        const end = at + 2 + (bytes[at + 2] << 8 | bytes[at + 3]);
        list.push([at, end]);
        at = end;
    }
    return list;
}

// Sets the orientation of SEGMENT to upright, and removes its thumbnail, if it is Exif.
function correctExif(segment) {
    const exif = "Exif\0\0", start = 4 + exif.length;
    if (segment[1] !== 0xe1 || segment.length < start + 8 || !exif.split("").every((c, i) => segment[4 + i] === c.charCodeAt(0)))
        return;
    const tiff = new DataView(segment.buffer, segment.byteOffset + start, segment.length - start);
    const little = tiff.getUint16(0) === 0x4949, ifd = tiff.getUint32(4, little);
    if (ifd + 2 > tiff.byteLength)
        return;
    const entries = tiff.getUint16(ifd, little), next = ifd + 2 + 12 * entries;
    if (next + 4 > tiff.byteLength)
        return;
    for (let at = ifd + 2; at < next; at += 12)
        if (tiff.getUint16(at, little) === 0x112)
            tiff.setUint16(at + 8, 1, little);
    tiff.setUint32(next, 0, little);
}

function startsWith(segment, text) {
    return text.split("").every((c, i) => segment[4 + i] === c.charCodeAt(0));
}

// Returns whether SEGMENT may be copied: Exif, the colour profile, IPTC, and XMP unless it states an orientation or
// a gain map. MPF (offsets of pictures in the file), APP11 (signatures) and APP14 (coding) fit only the photograph.
function isCopied(segment) {
    const marker = segment[1];
    if (marker < 0xe1 || marker > 0xef || marker === 0xeb || marker === 0xee || startsWith(segment, "MPF\0"))
        return false;
    return marker !== 0xe1 || !startsWith(segment, "http") ||
        !/tiff:Orientation|hdrgm:|GContainer/.test(new TextDecoder("latin1").decode(segment));
}

// Returns JPEG, a Blob, with the segments of PHOTO that isCopied() accepts, if that is a JPEG file.
export async function copyMetadata(photo, jpeg) {
    const from = new Uint8Array(await photo.arrayBuffer()), to = new Uint8Array(await jpeg.arrayBuffer());
    if (from[0] !== 0xff || from[1] !== 0xd8)
        return jpeg;
    const copied = segments(from).filter(([start, end]) => end - start >= 4 && end <= from.length)
        .map(([start, end]) => from.slice(start, end)).filter(isCopied);
    const [at] = segments(to).find(([start]) => to[start + 1] !== 0xe0); // after JFIF
    copied.forEach(correctExif);
    return new Blob([to.slice(0, at), ...copied, to.slice(at)], {type: "image/jpeg"});
}
