/* SPDX-License-Identifier: MIT
 *
 * vt [text|graphics] - prints or sets the mode of the visible console.
 */
#include <linux/kd.h>

#include "device.h"

int main(int argc, char **argv)
{
    int fd = open_device("/dev/tty0"), mode;
    if (argc > 1 &&
        ioctl(fd, KDSETMODE,
              strcmp(argv[1], "graphics") == 0 ? KD_GRAPHICS : KD_TEXT) < 0)
        die("KDSETMODE: %s", strerror(errno));
    must_ioctl(fd, KDGETMODE, &mode, "KDGETMODE");
    puts(mode == KD_GRAPHICS ? "graphics" : "text");
    return 0;
}
