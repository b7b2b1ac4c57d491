/* SPDX-License-Identifier: MIT
 *
 * Imports random bytes as a lens file of another program. The first byte
 * selects the format, 'a' being the first one, and --strict if the byte is odd.
 * The size selects the zoom position. A rejected file must have an error
 * message. An accepted file must give a lens table that parses, or that is
 * rejected with a position. A second import must give the same result.
 *
 *     make fuzz FUZZ=import SECONDS=60
 */
#include "fuzz/fuzz.h"
#include "import/imported.h"

static char *import_lens_from_copy(struct imported *lens,
                                   const struct import_format *format,
                                   const uint8_t *data, size_t size,
                                   bool strict, size_t *bytes)
{
    uint8_t *copy = malloc(size + 1);
    char *text;

    require(copy != NULL);
    memcpy(copy, data, size);
    *bytes = size;
    imported_init(lens, "f", strict);
    memcpy(lens->name, "fuzz", 5);
    lens->position = (int)(size % 4);
    text = import_parse_file(lens, format, copy, bytes);
    free(copy);
    return text;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct imported lens;
    static struct glint_prescription table;
    const struct import_format *format;
    struct glint_error error = {""};
    size_t bytes, again;
    char *text, *second;
    bool strict;

    if (size < 2 || size > 1 << 16)
        return 0;
    format = import_get_format((data[0] - 'a') / 2);
    strict = (data[0] - 'a') % 2 == 1;
    if (!format)
        return 0;
    text = import_lens_from_copy(&lens, format, data + 1, size - 1, strict,
                                 &bytes);
    if (!text) {
        require(strncmp(lens.error, "f:", 2) == 0 && lens.error[3]);
        return 0;
    }
    require(!strict || lens.n_guesses == 0);
    second = import_lens_from_copy(&lens, format, data + 1, size - 1, strict,
                                   &again);
    require(second && again == bytes && memcmp(text, second, bytes) == 0);
    if (glint_prescription_parse(&table, text, bytes, "t", &error) != GLINT_OK)
        require(strncmp(error.text, "t:", 2) == 0);
    free(text);
    free(second);
    return 0;
}
