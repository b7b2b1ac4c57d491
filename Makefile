# glint - physically based camera effects for small machines.
#
#   make          build/glint; needs a C compiler only, and takes in libjpeg
#                 and inih where it finds them
#   make TARGET=aarch64|armv7-neon|armv7|armv6-soft|x86_64
#                 build/TARGET/glint, static;  DYNAMIC=1: build/TARGET-dynamic
#   make glint-live   build/.../glint-live: the live command alone, for
#                 baked models; with TARGET= for a board
#   make corpus   photographs to try it on;  corpus-evaluate, HALF=tune|held:
#                 how well lamps are found in them
#   make demo     ghosts on a real photograph and a video  (DEPS=no: no apt)
#   make check    every test (VM=no: not in the emulator);  CONFIG=release|asan|tsan|qcheck  CC=gcc|clang
#   make check-arm  the run-time half's on ARM, in an emulator
#   make check-vm   of these those on Debian's kernels in an emulator, ARM too
#   make check-files   round trips of picture files, by exiftool, ImageMagick, ffmpeg
#   make mutants  planted faults, each of which a unit test has to catch
#   make check-valgrind   memory that was never written, by valgrind
#   make fuzz     every fuzzer for SECONDS=60, two at a time;  FUZZ=lens: that one
#   make analyze  clang-tidy, gcc -fanalyzer and cppcheck; zero findings
#   make extremes  the list of extremes, each with the worst figure seen and its bound
#   make lint     layers, Q formats, formatting, symbols;  purity: that the
#                 run-time half has no floats and calls nobody (TARGET= too)
#   make install  DESTDIR= PREFIX=/usr/local, TARGET= for a board, MODELS=no
#                 without baked models;  make uninstall
#   make bench    what a frame costs;  bench-insn: in instructions
#   make size     bytes of the run-time library, and of programs with parts of it
#   make budget   what a frame costs on ARM, in instructions and bytes
#   make growth   how that grows, as plots;  memory-table: what it takes
#   make video-report  how steady the flare of a video is; VIDEOS="A.y4m ..."
#   make trade    what accuracy costs: plots, pictures and a page (glint sweep)
#   also: oiio window table bake-table accuracy-table colour-table ray-table inputs format
#         golden-update fuzz-keep clean

MAKEFLAGS += -r
.DEFAULT_GOAL := all
CONFIG ?= release
ifeq ($(origin CC),default)
CC := gcc
endif
CXX     := g++
AR      ?= ar
NM      ?= nm
SIZE    ?= size
OBJDUMP ?= objdump
PREFIX  ?= /usr/local
# Static, for boards and the emulator, with the libraries of SYSROOT, if given
# (tests/vm/prepare makes one): armv7 has NEON kernels and those in C and takes
# what the CPU has, armv7-neon takes NEON for granted, armv6-soft has neither
# NEON nor a float unit. DYNAMIC=1: linked with the board's libraries. STATIC=1:
# this machine's own.
TARGETS := x86_64 aarch64 armv7-neon armv7 armv6-soft
ifdef STATIC
TARGET := $(firstword $(subst -, ,$(shell $(CC) -dumpmachine)))
endif
CROSS_x86_64  := x86_64-linux-gnu-
CROSS_aarch64 := aarch64-linux-gnu-
CROSS_armv7   := arm-linux-gnueabihf-
CROSS_armv7-neon := $(CROSS_armv7)
CROSS_armv6-soft := arm-linux-gnueabi-
PACKAGES_x86_64  := gcc-x86-64-linux-gnu libc6-dev-amd64-cross
PACKAGES_aarch64 := gcc-aarch64-linux-gnu libc6-dev-arm64-cross
PACKAGES_armv7   := gcc-arm-linux-gnueabihf libc6-dev-armhf-cross
PACKAGES_armv7-neon := $(PACKAGES_armv7)
PACKAGES_armv6-soft := gcc-arm-linux-gnueabi libc6-dev-armel-cross
MACHINE_armv7 := -march=armv7-a -mfpu=vfpv3-d16 -mfloat-abi=hard
MACHINE_armv7-neon := -march=armv7-a -mfpu=neon-vfpv4 -mfloat-abi=hard
MACHINE_armv6-soft := -march=armv6 -mfloat-abi=soft
ifdef TARGET
ifeq ($(filter $(TARGETS),$(TARGET)),)
$(error TARGET is one of $(TARGETS))
endif
ifneq ($(CONFIG),release)
$(error TARGET=$(TARGET) is for CONFIG=release)
endif
CROSS   := $(CROSS_$(TARGET))
ifeq ($(shell command -v $(CROSS)gcc),)
$(error $(CROSS)gcc is not there: apt-get install $(PACKAGES_$(TARGET)))
endif
CC      := $(CROSS)gcc
AR      := $(CROSS)ar
NM      := $(CROSS)nm
SIZE    := $(CROSS)size
OBJDUMP := $(CROSS)objdump
ifndef DYNAMIC
LDFLAGS += -static
endif
# only what a program calls is in it
SECTIONS := -ffunction-sections -fdata-sections
LDFLAGS += -Wl,--gc-sections
JPEG_CPPFLAGS := $(SYSROOT:%=-isystem %/include)
JPEG_LIBS     := $(SYSROOT:%=-L%/lib) -ljpeg
INIH_CPPFLAGS := $(SYSROOT:%=-isystem %/include)
INIH_LIBS     := $(SYSROOT:%=-L%/lib) -linih
endif
ARCH := $(if $(CROSS),$(TARGET),$(firstword $(subst -, ,$(shell $(CC) -dumpmachine))))
ifeq ($(ARCH),arm) # of which there are many
ARCH := $(shell $(CC) -dM -E -x c /dev/null | \
        awk '$$2 == "__ARM_ARCH" { print $$3 < 7 ? "armv6" : "armv7" }')
endif
OUT  := build/$(if $(CROSS),$(TARGET)$(if $(DYNAMIC),-dynamic),$(ARCH)-$(notdir $(CC))-$(CONFIG))
export DEPS OUT

# Libraries that glint can do without:  WITH_JPEG=yes|no  says which are used,
# else it is whether a program with them can be built.
has = $(shell printf '\043include <stdio.h>\n\043include <%s>\nint main(void) { return 0; }\n' $(1) | \
        $(CC) $(CPPFLAGS) $(2) -x c - $(LDFLAGS) $(3) -o /dev/null 2>/dev/null && echo yes || echo no)
JPEG_LIBS ?= -ljpeg
ifndef WITH_JPEG
WITH_JPEG := $(call has,jpeglib.h,$(JPEG_CPPFLAGS),$(JPEG_LIBS))
endif
INIH_LIBS ?= -linih
ifndef WITH_INIH
WITH_INIH := $(call has,ini.h,$(INIH_CPPFLAGS),$(INIH_LIBS))
endif

# Sources in the order the data flows.
CORE := base/status base/arena base/q base/divide base/sort base/image base/workers \
        kernels/sets kernels/kernels kernels/horner kernels/horner_c kernels/add_quads kernels/turn kernels/turn_c \
        kernels/composite_c \
        lens/model lens/transfer flare/bright flare/bright_mark flare/bright_scan flare/white flare/regions flare/row_light flare/score \
        flare/lights flare/light_rows flare/light_list \
        flare/profile flare/unclip \
        flare/match flare/follow flare/record flare/tracks tile/primitive \
        tile/clip tile/outline tile/bins tile/raster tile/edges tile/sums tile/curve tile/mix tile/codes \
        tile/resolve tile/quads tile/composite flare/beams flare/plan flare/wave_sets flare/ghost_grid flare/cuts \
        flare/ghost_edges flare/by_cells flare/by_edges flare/flare flare/account
BAKE := bake/text bake/films bake/prescription bake/check bake/glass bake/coating \
        bake/paraxial bake/ghosts bake/trace bake/pupil bake/survey bake/cells \
        bake/spectrum bake/setup bake/exact bake/feed bake/hunt bake/regress \
        bake/zone bake/brightness bake/fitted bake/zone_fit bake/fit \
        bake/shared_zone bake/shared_basis bake/published bake/quantise \
        bake/measure_model bake/write_model bake/bake
PLATFORM := posix/utf8 posix/error posix/process posix/at_death posix/input posix/target posix/output posix/workers \
        plain/pnm plain/pfm plain/y4m oiio/loader plain/picture linux/request linux/instructions \
        plain/half plain/tones plain/samples plain/kept_types plain/kept plain/y4m_layout plain/y4m_light \
        linux/sets linux/fourcc $(if $(filter yes,$(WITH_JPEG)),jpeg/mjpeg,jpeg/absent) \
        linux/v4l2_device linux/v4l2_buffers linux/v4l2_list linux/v4l2 \
        plain/split plain/row_rgb plain/row_pack plain/panel linux/console \
        linux/fbdev linux/v4l2_sink plain/planar plain/y4m_sink plain/null
PLATFORM += sdl/window
TOOLS := tool $(if $(filter yes,$(WITH_INIH)),config,config_absent) model_file model_cache coating \
        model_report measure area lamps paint show_lights frame frame_feed dials ladder cost budget scene_table scene_waves scene response strength look live_adapt \
        look_layer overlay_file overlay_picture overlay_y4m \
        live_signals live_output live_picture live_stats live_loop \
        explain explain_table explain_picture \
        cmd_bake cmd_info cmd_trace cmd_render overlay_video overlay_sequence overlay_line cmd_overlay cmd_explain cmd_live cmd_compare \
        yardstick bench_cases bench_growth bench_report cmd_bench plot sweep_plan sweep_exact sweep_frame \
        sweep_measure sweep_front sweep_csv sweep_svg sweep_png sweep_page cmd_sweep
# what one asks before one knows
TOOLS += suggest takes lens_files cmd_lenses child ffmpeg lamp_keys lamp_save live_scene live_input
EXTREMES := angles powers lenses frames caustics outlines sums runs
UNIT := arena divide cuts kernels model prescription films spectrum waves optics trace pupil published quantise bake \
        exact curve edges resolve composite lights flare plan account beams pnm y4m picture samples kept output workers \
        measure area lamps bright light_rows score profile match tracks utf8 at_death fourcc v4l2 v4l2_faults panel \
        fbdev sinks live_stats live_adapt frame strength show_lights sweep explain budget live \
        $(EXTREMES:%=extremes_%)
FUZZERS := lens model y4m pnm lights
ifeq ($(WITH_JPEG),yes)
UNIT += mjpeg
FUZZERS += mjpeg
else
UNIT += mjpeg_absent
endif
ifeq ($(WITH_INIH),yes)
UNIT += config
FUZZERS += config
else
UNIT += config_absent
endif

ifeq ($(CONFIG),tsan) # what starts threads or is interrupted by signals
UNIT := $(filter bake exact flare workers output at_death frame live,$(UNIT))
endif

CORE_x86_64  := kernels/horner_sse41 kernels/horner_avx2 kernels/turn_sse41 kernels/turn_avx2 \
        kernels/composite_sse41 kernels/composite_avx2
CORE_aarch64 := kernels/horner_neon kernels/turn_neon kernels/composite_neon
CORE_armv7   := $(CORE_aarch64)
CORE_armv7-neon := $(CORE_aarch64)
ifdef CROSS # a static program has no plug-ins
PLATFORM := $(PLATFORM:oiio/loader=oiio/absent)
PLATFORM := $(PLATFORM:sdl/window=sdl/absent)
endif
core_o     := $(patsubst %,$(OUT)/src/%.o,$(CORE) $(CORE_$(ARCH)))
bake_o     := $(BAKE:%=$(OUT)/src/%.o)
platform_o := $(PLATFORM:%=$(OUT)/platform/%.o)
tools_o    := $(TOOLS:%=$(OUT)/tools/%.o)

CPPFLAGS := -Iinclude -D_FILE_OFFSET_BITS=64
WARN := -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wstrict-prototypes \
        -Wmissing-prototypes -Wvla -Wdouble-promotion -Wundef $(WERROR)
CFLAGS := $(MACHINE_$(TARGET)) $(SECTIONS) -std=c99 -O2 -g -ffp-contract=off -fvisibility=hidden $(WARN)
LDLIBS := $(if $(filter yes,$(WITH_JPEG)),$(JPEG_LIBS)) \
        $(if $(filter yes,$(WITH_INIH)),$(INIH_LIBS)) -lm -lpthread -ldl
$(OUT)/src/%.o $(OUT)/tests/%.o: CPPFLAGS += -Isrc
$(OUT)/tests/%.o: CPPFLAGS += -Itests
$(OUT)/platform/%.o $(OUT)/tools/%.o $(OUT)/tests/%.o: CPPFLAGS += \
        -Iplatform -Itools -D_POSIX_C_SOURCE=200809L \
        -DGLINT_SHARE_DIR='"$(PREFIX)/share/glint"' \
        -DGLINT_PLUGIN_DIR='"$(PREFIX)/lib/glint"'
# what knows it is made anew where PREFIX is another
$(OUT)/tools/lens_files.o $(OUT)/platform/oiio/loader.o \
$(OUT)/platform/sdl/window.o: $(OUT)/prefix
$(OUT)/prefix: always
	@mkdir -p $(@D); echo '$(PREFIX)' | cmp -s - $@ || echo '$(PREFIX)' >$@
# What reads files of others is guarded against what no test has found; the
# run-time half, which has no copies and no arrays of a length from outside, is
# as it was. A sanitizer sees more by itself, and -O0 takes no _FORTIFY_SOURCE.
LINKED := -Wl,-z,relro,-z,now
ifeq ($(filter -static,$(LDFLAGS)),)
CFLAGS += -fPIE
LINKED += -pie
endif
ifneq ($(filter release qcheck,$(CONFIG)),)
$(bake_o) $(platform_o) $(tools_o) $(OUT)/tools/glint.o $(OUT)/tools/glint_live.o \
$(OUT)/tools/models_only.o: CFLAGS += -fstack-protector-strong -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2
endif
# On boards what is around the frames is small rather than fast; rows of pixels
# and what is measured by are set below.
ifdef CROSS
$(platform_o) $(tools_o) $(OUT)/tools/glint_live.o $(OUT)/tools/models_only.o: CFLAGS += -Os -fno-asynchronous-unwind-tables -fno-unwind-tables
endif
# Run-time half: no library, small stack frames; --gc-sections takes out what is
# not called.
$(core_o): CFLAGS += -ffreestanding -ffunction-sections -Wframe-larger-than=1024 -fno-asynchronous-unwind-tables
# What runs once, or once for a lamp, bundle or row, is small rather than fast, and
# so is what takes cells to tiles.
$(patsubst %,$(OUT)/src/%.o,base/status base/arena base/image base/workers lens/model flare/lights flare/light_list flare/match \
        flare/follow flare/record flare/tracks flare/beams flare/plan flare/wave_sets flare/flare flare/account \
        flare/ghost_grid flare/by_cells tile/bins tile/clip tile/resolve tile/curve \
        tile/mix): CFLAGS += -Os
# An instruction set is a file-name suffix; nothing else may use its flags.
$(OUT)/src/%_sse41.o: CFLAGS += -msse4.1
$(OUT)/src/%_avx2.o: CFLAGS += -mavx2
ifeq ($(ARCH),armv7)
$(OUT)/src/%_neon.o: CFLAGS += -mfpu=neon
endif
# Hot loops: unrolled, or where that buys nothing but bytes in vectors alone.
$(OUT)/src/kernels/%.o $(patsubst %,$(OUT)/src/%.o,tile/edges flare/bright_mark flare/bright_scan flare/row_light \
        flare/ghost_edges): CFLAGS += -O3
$(patsubst %,$(OUT)/src/%.o,tile/codes tile/quads tile/sums flare/by_edges lens/transfer): CFLAGS += -ftree-vectorize
$(OUT)/src/tile/edges.o: CFLAGS += -fno-tree-vectorize # short loops
ifeq ($(ARCH)-$(findstring gcc,$(CC)),aarch64-gcc)
# else constants that are hoisted push out tables: a tenth more instructions
$(OUT)/src/kernels/composite_neon.o: CFLAGS += -fno-move-loop-invariants
endif
ifneq ($(filter armv7%,$(ARCH)),) # 16 vectors for 40: the rest spills
$(OUT)/src/kernels/composite_neon.o: CFLAGS += -Wframe-larger-than=1536
endif
ifneq ($(findstring clang,$(CC)),) # likewise, of 32 bytes each
$(OUT)/src/kernels/composite_avx2.o: CFLAGS += -Wframe-larger-than=1536
endif
# the floor that everything is measured by is as fast as can be
$(OUT)/tools/yardstick.o: CFLAGS += -O3
# what every frame of a camera goes through on its way to a panel
$(OUT)/platform/plain/split.o $(OUT)/platform/plain/row_rgb.o \
$(OUT)/platform/plain/row_pack.o $(OUT)/platform/plain/planar.o: CFLAGS += -O3
$(OUT)/src/bake/regress.o: CFLAGS += -O3 # sums in fours: same bits
# rays in eights: errno and traps are all that these give away
$(OUT)/src/bake/trace.o: CFLAGS += -O3 -fno-math-errno -fno-trapping-math
ifeq ($(CONFIG),asan)
CPPFLAGS += -DGLINT_SANITIZED
CFLAGS += -O1 -fsanitize=address,undefined -fno-sanitize-recover=all
$(core_o): CFLAGS += -Wno-frame-larger-than
else ifeq ($(CONFIG),tsan)
CPPFLAGS += -DGLINT_SANITIZED
CFLAGS += -O1 -fsanitize=thread
$(core_o): CFLAGS += -Wno-frame-larger-than
else ifeq ($(CONFIG),fuzz) # what make fuzz builds; clang only
CPPFLAGS += -DGLINT_SANITIZED
CFLAGS += -O1 -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all
$(core_o): CFLAGS += -Wno-frame-larger-than
else ifeq ($(CONFIG),analyze) # what make analyze builds; gcc only
# as it is written: -O0 keeps functions and their messages apart
ANALYZER := -O0 -fanalyzer -Wno-frame-larger-than
# gcc 12 does not see what its own intrinsics write
$(OUT)/src/%_sse41.o $(OUT)/src/%_avx2.o: ANALYZER := -O0 -Wno-frame-larger-than
# nor that a float made of a double is something
$(OUT)/platform/plain/samples.o: ANALYZER += -Wno-analyzer-use-of-uninitialized-value
# nor that a picture in an array of the sweep's is the sweep's
$(OUT)/tools/sweep_measure.o: ANALYZER += -Wno-analyzer-malloc-leak
TIDY = $(Q)clang-tidy --quiet $< -- $(CPPFLAGS) $(filter-out $(WARN),$(CFLAGS))
else ifeq ($(CONFIG),qcheck)
CPPFLAGS += -DGLINT_Q_CHECK
else ifneq ($(CONFIG),release)
$(error CONFIG is release, asan, tsan or qcheck)
endif

$(OUT)/platform/jpeg/mjpeg.o $(OUT)/tests/%_mjpeg.o: CPPFLAGS += $(JPEG_CPPFLAGS)
$(OUT)/tools/config.o: CPPFLAGS += $(INIH_CPPFLAGS)
$(OUT)/platform/jpeg/absent.o: NOTE := MJPEG left out: no libjpeg62-turbo-dev
$(OUT)/tools/config_absent.o: NOTE := --config left out: no libinih-dev

$(OUT)/%.o: %.c
	@mkdir -p $(@D)
	$(say) CC $<
	$(if $(NOTE),@echo ' $(NOTE)')
	$(TIDY)
	$(Q)$(CC) $(CPPFLAGS) -MMD -MP $(CFLAGS) $(ANALYZER) -c $< -o $@

$(OUT)/libglint.a: $(core_o)
$(OUT)/libglint-bake.a: $(bake_o)
$(OUT)/libglint-platform.a: $(platform_o)
$(OUT)/libglint-tools.a: $(tools_o)
$(OUT)/lib%.a:
	$(say) AR $@
	$(Q)rm -f $@; $(AR) rcs $@ $(filter %.o,$^)
# what is built in: another choice makes other archives
$(OUT)/libglint-platform.a $(OUT)/libglint-tools.a: $(OUT)/parts
$(OUT)/parts: always
	@mkdir -p $(@D); echo $(PLATFORM) $(TOOLS) | cmp -s - $@ || \
	        echo $(PLATFORM) $(TOOLS) >$@
libs := $(OUT)/libglint-tools.a $(OUT)/libglint-platform.a \
        $(OUT)/libglint-bake.a $(OUT)/libglint.a

define link
	@mkdir -p $(@D)
	$(say) LD $@
	$(Q)$(CC) $(CFLAGS) $(LINKED) $(LDFLAGS) $(filter %.o,$^) $(libs) $(EXTRA) \
	        $(LDLIBS) -o $@
endef

# What stands at the top of this file.
help:
	@sed -n '2,/^$$/s/^# \{0,1\}//p' $(firstword $(MAKEFILE_LIST))
all: $(if $(CROSS),$(OUT)/glint,build/glint)
build/glint: $(OUT)/glint always
	$(Q)cmp -s $< $@ || { cp -f $< $@.tmp && mv -f $@.tmp $@; }
always:
$(OUT)/glint: $(OUT)/tools/glint.o $(libs)
	$(link)

# Programs that take one part of the run-time library, and no other half.
EXAMPLES := ghost_rays add_glow find_lamps draw_flare
example_bins := $(EXAMPLES:%=$(OUT)/examples/%)
$(OUT)/tools/examples/%.o: CPPFLAGS += -Itools/examples
$(example_bins): $(OUT)/examples/%: $(OUT)/tools/examples/%.o $(OUT)/libglint.a
	@mkdir -p $(@D)
	$(say) LD $@
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -Wl,--gc-sections,-Map=$@.map $^ -lm -o $@

# The live command alone, for baked models, stripped.
glint-live: $(OUT)/glint-live
$(OUT)/glint-live: LDFLAGS += -s -Wl,--gc-sections
$(OUT)/glint-live: $(OUT)/tools/glint_live.o $(OUT)/tools/models_only.o $(libs)
	$(link)

# The image plug-in, the only C++: PNG, JPEG, EXR ... through OpenImageIO.
oiio: build/glint-oiio.so
OIIO := $(addprefix platform/oiio/,oiio.cc keep.cc carry.cc carry_tiff.cc webp.cc)
build/glint-oiio.so: $(OIIO) $(wildcard platform/oiio/*.h) platform/plain/samples.h platform/plain/tones.h
	@mkdir -p $(@D)
	$(say) CXX '$(OIIO)'
	$(Q)$(CXX) -std=c++17 -O2 -Wall -Wextra -fPIC -fvisibility=hidden -shared -Iinclude -Iplatform \
	        $(OIIO) -o $@ $$(pkg-config --cflags --libs OpenImageIO) \
	        $$(pkg-config --exists libwebp && pkg-config --cflags --libs libwebp)

# The window of glint live -o window, through SDL2.
window: build/glint-sdl.so
build/glint-sdl.so: platform/sdl/sdl.c platform/sdl/sdl.h
	@mkdir -p $(@D)
	$(say) CC $<
	$(Q)$(CC) -std=c99 -O2 $(filter-out -Wundef,$(WARN)) -fPIC -fvisibility=hidden -shared -Iinclude -Iplatform \
	        $< -o $@ $$(pkg-config --cflags --libs sdl2)

# ------------------------------------------------------------------- to see
video-report: $(OUT)/steady
	$(OUT)/steady --lens lenses/nikon-zoom-short.lens $(VIDEOS)
demo:
	@tools/deps "PNG and JPEG pictures, and video to look at" g++ pkg-config \
	        libopenimageio-dev libwebp-dev ffmpeg
	@$(MAKE) --no-print-directory all \
	        $(shell [ "$(DEPS)" = no ] || echo oiio)
	@tools/demo
inputs:
	@tools/inputs
table: all
	@tools/raster-table | tools/write-figures raster
bake-table: all $(OUT)/ray_errors
	@tools/bake-table | tools/write-figures bake
accuracy-table: all
	@tools/accuracy-table | tools/write-figures accuracy
colour-table: all $(OUT)/hue_steps
	@tools/deps "instruction counts" valgrind >&2
	@HUE_STEPS=$(OUT)/hue_steps tools/colour-table | tools/write-figures colour
ray-table: all $(OUT)/ray_errors
	@tools/ray-table build/bake | tools/write-figures rays
$(OUT)/ray_errors: $(OUT)/tools/ray_errors.o $(libs)
	$(link)
# Photographs of Debian packages with their lamps marked: tests/corpus/README.md.
corpus:
	@tools/deps "photographs from Debian packages" python3-pil python3-numpy \
	        ffmpeg openimageio-tools
	@tests/corpus/fetch
HALF ?= tune
corpus-evaluate: corpus $(OUT)/corpus-found
	@tests/corpus/evaluate --half $(HALF) --sheet build/corpus/found-$(HALF).jpg
# All pictures beside what glint makes of them; how bright it is, lens by lens.
corpus-sheet: corpus all
	@tests/corpus/overlays build/corpus/sheet
corpus-report: corpus all
	@tests/corpus/report build/corpus/report.csv
$(OUT)/tests/corpus/%.o: CPPFLAGS += -Itools/examples
$(OUT)/corpus-found: $(OUT)/tests/corpus/found.o $(libs)
	$(link)
# The weights of src/flare/score.c, from the pictures that are there to tune on.
corpus-fit: corpus $(OUT)/corpus-features
	@OUT=$(OUT) tests/corpus/fit
$(OUT)/corpus-features: $(OUT)/tests/corpus/features.o $(libs)
	$(link)
bench: all
	@build/glint bench
growth: all
	@tools/growth | tools/write-figures growth
size: $(OUT)/libglint.a $(example_bins)
	@tools/size $(SIZE) $(OUT) $(EXAMPLES)
trade: all
	@build/glint sweep -o build/trade $(TRADE)
	@echo build/trade/index.html
memory-table: all
	@tools/memory-table | tools/write-figures memory
budget: all
	@tools/deps "instruction counts on ARM" gcc-aarch64-linux-gnu \
	        libc6-dev-arm64-cross gcc-arm-linux-gnueabihf \
	        libc6-dev-armhf-cross qemu-user valgrind >&2
	@for t in aarch64 armv7; do $(MAKE) -s --no-print-directory TARGET=$$t \
	        build/$$t/glint >&2 || exit 1; done
	@tools/budget | tools/write-figures arm
bench-insn: all
	@tools/deps "instruction counts" valgrind
	@tools/bench-insn

power-table: $(OUT)/power_table
	@tools/deps "HDR panoramas" openimageio-tools python3 npm
	@tests/power-table $<
# ------------------------------------------------------------------- to test
test_bins := $(UNIT:%=$(OUT)/tests/unit/test_%)
$(test_bins): EXTRA := $(SYSROOT:%=-L%/lib) -lcmocka
ifdef CROSS # of which Debian has a shared library only
$(OUT)/tests/%.o: CPPFLAGS += $(SYSROOT:%=-isystem %/include)
$(test_bins): LDFLAGS := $(filter-out -static,$(LDFLAGS))
endif
# Calls that tests answer themselves, or let fail.
$(OUT)/tests/unit/test_fbdev: LDFLAGS += -Wl,--wrap=open64,--wrap=ioctl \
        -Wl,--wrap=mmap64,--wrap=munmap,--wrap=malloc
$(OUT)/tests/unit/test_workers: LDFLAGS += -Wl,--wrap=pthread_create
$(OUT)/tests/unit/test_sinks: LDFLAGS += -Wl,--wrap=ioctl,--wrap=write
FAKE_CAMERA := ioctl open64 stat64 close read mmap64 munmap malloc calloc \
        realloc posix_memalign free strdup realpath clock_gettime nanosleep glint_mjpeg_available
fake_bins := $(patsubst %,$(OUT)/tests/unit/test_%,v4l2 v4l2_faults live)
$(OUT)/tests/unit/test_live: LDFLAGS += -Wl,--wrap=ppoll
$(OUT)/tests/unit/test_frame: LDFLAGS += -Wl,--wrap=malloc,--wrap=calloc \
        -Wl,--wrap=realloc,--wrap=posix_memalign
$(OUT)/tests/unit/test_budget: LDFLAGS += -Wl,--wrap=tool_seconds
$(fake_bins): LDFLAGS += $(FAKE_CAMERA:%=-Wl,--wrap=%)
$(fake_bins): $(OUT)/tests/support/fake_camera.o
extreme_bins := $(EXTREMES:%=$(OUT)/tests/unit/test_extremes_%)
$(extreme_bins): $(OUT)/tests/support/stage.o
$(test_bins): $(OUT)/tests/unit/test_%: $(OUT)/tests/unit/test_%.o $(libs)
	$(link)
replay_bins := $(FUZZERS:%=$(OUT)/tests/fuzz/replay_%)
$(replay_bins): $(OUT)/tests/fuzz/replay_%: $(OUT)/tests/fuzz/fuzz_%.o \
        $(OUT)/tests/fuzz/replay.o $(libs)
	$(link)
$(OUT)/hue_steps: $(OUT)/tests/support/hue_steps.o $(libs)
	$(link)
$(OUT)/pan: $(OUT)/tests/support/pan.o $(libs)
	$(link)
$(OUT)/tests/unit/test_profile: $(OUT)/tests/support/power_scene.o
$(OUT)/power_table: $(OUT)/tests/support/power_table.o \
        $(OUT)/tests/support/power_scene.o $(libs)
	$(link)
$(OUT)/steady: $(OUT)/tests/support/steady.o $(libs)
	$(link)
$(OUT)/motion: $(OUT)/tests/support/motion.o $(OUT)/tests/support/stage.o $(libs)
	$(link)
$(OUT)/random_lenses: $(OUT)/tests/support/random_lenses.o \
        $(OUT)/tests/support/random_lens.o $(OUT)/tests/support/stage.o $(libs)
	$(link)

check:
	@tools/deps "unit tests, lint" gcc libc6-dev binutils \
	        libcmocka-dev clang clang-format libjpeg62-turbo-dev libinih-dev
	@$(MAKE) --no-print-directory WERROR=-Werror run-check
	@[ $(notdir $(CC))-$(CONFIG)$(VM) != gcc-release ] || \
	        ! tests/vm/possible $(VM_ARCHS) || \
	        $(MAKE) --no-print-directory DEPS=no check-vm
run-check: lint $(test_bins) $(replay_bins) $(OUT)/glint $(OUT)/pan $(OUT)/ray_errors $(example_bins) \
        $(OUT)/motion $(OUT)/random_lenses
	@GLINT_QUICK=$(filter asan tsan,$(CONFIG)) tests/run $(test_bins) -- \
	        $(replay_bins)
	@[ -n "$(filter asan tsan,$(CONFIG))" ] || tests/extremes --quick
# What other programs find in files that overlay has written.
check-files:
	@tools/deps "picture files as other programs see them" g++ pkg-config libopenimageio-dev \
	        libwebp-dev openimageio-tools libimage-exiftool-perl imagemagick ffmpeg
	@$(MAKE) --no-print-directory all oiio
	@GLINT=build/glint GLINT_OIIO=build/glint-oiio.so tests/cli-files
	@GLINT=build/glint tests/cli-video
	@tests/install
# Long cases and random lenses too:  make extremes SEED=1 COUNT=500
extremes: $(extreme_bins) $(OUT)/random_lenses $(OUT)/motion
	@tests/extremes $(SEED:%=--seed %) $(COUNT:%=--count %)
# Faults planted in copies of the tree: MUTANTS=names, or all.
mutants: $(test_bins)
	@tests/mutants/run $(OUT) $(MUTANTS)
# What valgrind says of memory that was never written, which no sanitizer of
# gcc's does: the run-time half, what reads files, and the fuzzers' corpora.
VALGRIND := $(filter arena kernels model curve resolve lights flare plan beams pnm y4m \
        picture bright match lamps mjpeg config prescription trace,$(UNIT))
check-valgrind:
	@tools/deps "memory checks" gcc libc6-dev valgrind libcmocka-dev \
	        libjpeg62-turbo-dev libinih-dev
	@$(MAKE) --no-print-directory WERROR=-Werror run-valgrind
run-valgrind: $(VALGRIND:%=$(OUT)/valgrind/unit/test_%) \
        $(FUZZERS:%=$(OUT)/valgrind/fuzz/replay_%)
$(OUT)/valgrind/%: $(OUT)/tests/% always
	@mkdir -p $(@D)
	$(say) VALGRIND $*
	@GLINT_QUICK=valgrind valgrind -q --error-exitcode=9 --leak-check=full \
	        --errors-for-leak-kinds=definite --log-file=$@.log $< \
	        $(patsubst fuzz/replay_%,tests/fuzz/corpus/%,$(filter fuzz/%,$*)) \
	        >$@.out 2>&1 || { cat $@.out $@.log; exit 1; }
# The run-time half on ARM, in an emulator that runs programs: the same tests,
# the same hashes, with models baked here (tests/arm/check).
ARM_TARGETS := aarch64 armv7 armv7-neon armv6-soft
ARM_MODELS  := heliar-tronnier double-gauss-angenieux nikon-zoom-mid
ARM_UNIT := arena divide cuts kernels model curve edges resolve composite lights flare plan account beams bright match \
        tracks quantise pnm y4m output workers measure lamps fourcc panel frame \
        show_lights live_stats live_adapt
# Those that want a model bake it here first, for all.
ARM_BAKES := $(OUT)/tests/unit/test_frame
build/models/%.glint: lenses/%.lens $(OUT)/libglint-bake.a | $(OUT)/glint
	@mkdir -p $(@D)
	$(say) BAKE $@
	$(Q)$(OUT)/glint bake $< -q -o $@
$(OUT)/scenes: $(OUT)/tests/arm/scenes.o $(libs)
	$(link)
arm-tests: $(ARM_UNIT:%=$(OUT)/tests/unit/test_%)
check-arm:
	@tools/deps "ARM in an emulator" gcc-aarch64-linux-gnu libc6-dev-arm64-cross \
	        gcc-arm-linux-gnueabihf libc6-dev-armhf-cross gcc-arm-linux-gnueabi \
	        libc6-dev-armel-cross qemu-user-static debian-archive-keyring
	@$(MAKE) --no-print-directory WERROR=-Werror $(OUT)/scenes $(ARM_BAKES) \
	        $(ARM_MODELS:%=build/models/%.glint)
	@set -e; for t in $(ARM_TARGETS); do \
	        $(MAKE) --no-print-directory WERROR=-Werror TARGET=$$t purity \
	                build/$$t/scenes; done; \
	for t in aarch64 armv7; do s=$$(tests/arm/prepare $$t); \
	        $(MAKE) --no-print-directory WERROR=-Werror TARGET=$$t \
	                SYSROOT=$$s arm-tests glint-live build/$$t/examples/draw_flare; \
	done
	@XDG_CACHE_HOME=$(CURDIR)/build/cache $(ARM_BAKES) >/dev/null 2>&1
	@tests/arm/check $(ARM_MODELS:%=build/models/%.glint) -- $(ARM_UNIT)
# glint on Debian's kernels in an emulator: cameras, panels, ARM. One:
# VMFILTER=aarch64/camera, as tests/vm/check says.
VM_ARCHS ?= x86_64 aarch64 armv7
VM_TOOLS := as bars ctl feed grab vt
vm_cache := $(or $(XDG_CACHE_HOME),$(HOME)/.cache)/glint/vm
$(OUT)/vm/%: tests/vm/%.c tests/vm/device.h tests/vm/layout.h
	@mkdir -p $(@D)
	$(say) CC $<
	$(Q)$(CC) $(CPPFLAGS) -D_POSIX_C_SOURCE=200809L $(CFLAGS) $(LDFLAGS) $< -o $@
# what makes scenes and says what must come of them
VM_HOST := scene expected $(if $(filter yes,$(WITH_JPEG)),jpeg)
$(OUT)/vm/jpeg: CPPFLAGS += $(JPEG_CPPFLAGS)
$(VM_HOST:%=$(OUT)/vm/%): $(OUT)/vm/%: tests/vm/%.c tests/vm/layout.h $(libs)
	@mkdir -p $(@D)
	$(say) CC $<
	$(Q)$(CC) $(CPPFLAGS) -Iplatform -D_POSIX_C_SOURCE=200809L $(CFLAGS) \
	        $(LDFLAGS) $< $(libs) $(LDLIBS) -o $@
vm-programs: $(OUT)/glint $(OUT)/glint-live $(VM_TOOLS:%=$(OUT)/vm/%) \
        $(if $(filter x86_64,$(TARGET)),$(VM_HOST:%=$(OUT)/vm/%))
	@:
vm-deps:
	@tools/deps "cameras, panels and ARM in an emulator" qemu-system-x86 \
	        qemu-system-arm qemu-system-data seabios cpio kmod xz-utils \
	        device-tree-compiler debian-archive-keyring gcc-aarch64-linux-gnu \
	        libc6-dev-arm64-cross gcc-arm-linux-gnueabihf libc6-dev-armhf-cross strace xxd
	@[ "$(DEPS)" = no ] || for a in x86_64 $(VM_ARCHS); do \
	        tests/vm/prepare $$a || exit 1; done
check-vm: vm-deps
	@tests/vm/possible $(VM_ARCHS) || exit 0; set -e; \
	for a in x86_64 $(VM_ARCHS); do tests/vm/prepare $$a; \
	        $(MAKE) --no-print-directory WERROR=-Werror TARGET=$$a \
	                SYSROOT=$(vm_cache)/$$a/sysroot vm-programs; done; \
	tests/vm/check $(VM_ARCHS)
golden-update: $(OUT)/tests/unit/test_flare
	@GLINT_GOLDEN_UPDATE=1 $<

# Every fuzzer for SECONDS, or one:  make fuzz FUZZ=lens SECONDS=600. What they
# come to know stays in build/fuzz; fuzz-keep takes from there into the corpora
# what reaches code that these do not.
FUZZ    ?= $(FUZZERS)
SECONDS ?= 60
ifneq ($(filter-out $(FUZZERS),$(FUZZ)),)
$(error FUZZ is one of $(FUZZERS))
endif
fuzz_bins := $(FUZZ:%=$(OUT)/fuzz_%)
$(fuzz_bins): LDFLAGS += -fsanitize=fuzzer
$(fuzz_bins): $(OUT)/fuzz_%: $(OUT)/tests/fuzz/fuzz_%.o $(libs)
	$(link)
fuzz fuzz-keep:
	@tools/deps "libFuzzer" clang libclang-rt-14-dev
	@$(MAKE) --no-print-directory CC=clang CONFIG=fuzz run-$@
run-fuzz run-fuzz-keep: $(fuzz_bins)
	@tests/fuzz/run $(@:run-%=%) $(SECONDS) $^

# Static analysis, of what has changed since the last time.
analyze:
	@tools/deps "static analysis" gcc clang-tidy cppcheck
	@$(MAKE) --no-print-directory CC=gcc CONFIG=analyze WERROR=-Werror run-analyze
run-analyze: $(core_o) $(bake_o) $(platform_o) $(tools_o) $(OUT)/tools/glint.o
	$(say) CPPCHECK 'src platform tools'
	@mkdir -p $(OUT)/cppcheck
	$(Q)cppcheck -q --std=c99 --language=c --error-exitcode=1 \
	        --enable=warning,performance,portability,style --inline-suppr \
	        --suppressions-list=tools/cppcheck-suppressions \
	        --cppcheck-build-dir=$(OUT)/cppcheck -Iinclude -Isrc -Iplatform -Itools \
	        -D__x86_64__ -D__GNUC__ -D_POSIX_C_SOURCE=200809L \
	        $(patsubst $(OUT)/%.o,%.c,$(filter %.o,$^))

sources = $(shell find include src platform tools tests -name '*.[ch]')
format:
	$(Q)clang-format -i $(sources)
lint: $(OUT)/libglint.a $(OUT)/libglint-bake.a
	@tools/lint-layers && tools/lint-q
	@tools/lint-symbols $(NM) $(OUT)/libglint.a $(OUT)/libglint-bake.a
	@[ $(CONFIG) != release ] || \
	        $(MAKE) -s --no-print-directory purity
	@clang-format --dry-run -Werror $(sources)
	@for h in include/glint/*.h; do \
	        $(CC) -Iinclude -std=c99 -fsyntax-only -x c $$h || exit 1; \
	        ! command -v $(CXX) >/dev/null || \
	        $(CXX) -Iinclude -fsyntax-only -x c++ $$h || exit 1; done

# Of the objects alone, so for machines that cannot be run here, too.
purity: $(OUT)/libglint.a
	@tools/lint-purity $(NM) $(OBJDUMP) $<

# ---------------------------------------------------------------- to install
# With TARGET= for a board: copy DESTDIR there, or make it a part of its image.
# The image plug-in is built where it can be. MODELS=no: without baked models of
# the lenses, which take minutes where there are none yet.
program := $(if $(CROSS),$(OUT)/glint,build/glint)
PLUGIN  ?= $(if $(CROSS),no,$(shell command -v $(CXX) >/dev/null && \
        pkg-config --exists OpenImageIO 2>/dev/null && echo yes || echo no))
WINDOW  ?= $(if $(CROSS),no,$(shell pkg-config --exists sdl2 2>/dev/null && echo yes || echo no))
MODELS  ?= $(if $(CROSS),no,yes)
to := $(DESTDIR)$(PREFIX)
install: all glint-live $(if $(filter yes,$(PLUGIN)),build/glint-oiio.so) \
        $(if $(filter yes,$(WINDOW)),build/glint-sdl.so)
	install -d $(to)/bin $(to)/include/glint $(to)/lib/glint \
	        $(to)/share/glint/lenses $(to)/lib/systemd/system
	install $(if $(CROSS),-s --strip-program=$(CROSS)strip) -m 755 \
	        $(program) $(OUT)/glint-live $(to)/bin
	install -m 644 include/glint/*.h $(to)/include/glint
	install -m 644 $(OUT)/libglint.a $(OUT)/libglint-bake.a $(to)/lib
	install -m 644 lenses/*.lens $(to)/share/glint/lenses
	sed 's,@PREFIX@,$(PREFIX),' platform/linux/glint-live.service \
	        >$(to)/lib/systemd/system/glint-live.service
	chmod 644 $(to)/lib/systemd/system/glint-live.service
	$(if $(filter yes,$(PLUGIN)),install -m 755 build/glint-oiio.so $(to)/lib/glint, \
	        @echo 'without the image plug-in (g++, pkg-config, libopenimageio-dev): PPM, PFM and y4m')
	$(if $(filter yes,$(WINDOW)),install -m 755 build/glint-sdl.so $(to)/lib/glint)
ifneq ($(MODELS),no)
	@echo 'baking the models of all lenses, where there are none yet (MODELS=no: later)'
	rm -rf build/models-installed # of other tables
	build/glint lenses --models build/models-installed
	install -d $(to)/share/glint/models
	install -m 644 build/models-installed/*.glint $(to)/share/glint/models
endif
# What install put there, and folders that are empty then.
uninstall:
	rm -f $(to)/bin/glint $(to)/bin/glint-live $(to)/lib/libglint.a \
	        $(to)/lib/libglint-bake.a $(to)/lib/glint/glint-oiio.so \
	        $(to)/lib/glint/glint-sdl.so \
	        $(to)/lib/systemd/system/glint-live.service \
	        $(patsubst %,$(to)/%,$(wildcard include/glint/*.h)) \
	        $(patsubst %,$(to)/share/glint/%,$(wildcard lenses/*.lens)) \
	        $(to)/share/glint/models/*.glint
	@for d in include/glint lib/glint share/glint/models share/glint/lenses share/glint \
	        lib/systemd/system lib/systemd; do \
	        if [ -d $(to)/$$d ]; then rmdir --ignore-fail-on-non-empty $(to)/$$d; fi; done
clean:
	rm -rf build
.PHONY: window check-files all help video-report corpus corpus-evaluate corpus-fit corpus-sheet corpus-report glint-live always oiio demo inputs table bake-table accuracy-table colour-table ray-table bench bench-insn budget size growth trade memory-table check run-check extremes mutants check-arm arm-tests check-valgrind run-valgrind check-vm vm-deps vm-programs golden-update fuzz fuzz-keep run-fuzz run-fuzz-keep analyze run-analyze format \
        lint purity install uninstall clean
Q   := $(if $(V),,@)
say := @$(if $(V),:,printf ' %s %s\n')
-include $(shell find $(OUT) -name '*.d' 2>/dev/null)
