# glint - physically based camera effects for small machines.
#
#   make          build/glint; needs a C compiler only, and takes in libjpeg,
#                 libpng, jansson and expat where it finds them
#   make TARGET=aarch64|armv7-neon|armv7|armv6-soft|x86_64
#                 build/TARGET/glint, static;  DYNAMIC=1: build/TARGET-dynamic
#   make glint-live   build/.../glint-live: the live command alone, for
#                 baked models; with TARGET= for a board
#   make corpus   photographs to try it on;  corpus-evaluate, HALF=tune|held:
#                 how well lamps are found in them
#   make demo     ghosts on a real photograph and a video  (DEPS=no: no apt)
#   make check    every test;  CONFIG=release|asan|tsan|qcheck  CC=gcc|clang
#   make test TEST=NAME   one test, and all that it prints
#   make check-arm  the run-time half's on ARM, in an emulator
#   make check-vm   of these those on Debian's kernels in an emulator, ARM too
#   make check-files   round trips of picture files, by other programs;  check-commands: every command documented
#   make check-all  what a release must pass: all of these, about three hours
#   make mutants  planted faults, each of which a unit test has to catch
#   make check-valgrind   memory that was never written, by valgrind
#   make fuzz     every fuzzer for SECONDS=60, two at a time;  FUZZ=lens: that one
#   make analyze  clang-tidy, gcc -fanalyzer and cppcheck; zero findings
#   make extremes  the list of extremes, each with the worst figure seen and its bound
#   make lint     layers, Q formats, formatting, symbols;  purity: that the
#                 run-time half has no floats and calls nobody (TARGET= too)
#   make install  DESTDIR= PREFIX=/usr/local, TARGET= for a board's image,
#                 MODELS=no without baked models;  make uninstall
#   make board    TARGET=: an archive to unpack on a board
#   make shared   shared libraries;  install-library: these, archives, headers
#                 and pkg-config files alone;  dist: the sources, packed;
#                 abi REF=REVISION: what has changed of them since, by abidiff
#   make man      manual pages, into build/man
#   make web      the page of tools/hosts/web, for browsers, into build/web;  check-web: 200 pictures of it
#   make npm      the WebAssembly module as a package for npm, into build/npm
#   make frei0r, gstreamer, obs   plug-ins for hosts of video;  check-frei0r-threads, check-gstreamer, check-obs
#   make bench    what a frame costs;  figure NAME=frame: in instructions
#   make size     bytes of the run-time library, and of programs with parts of it
#   make budget   what a frame costs on ARM, in instructions
#   make figure NAME=accuracy   a table of tests/figures measured again; figures-quick: some rows compared
#   make video-report  how steady the flare of a video is; VIDEOS="A.y4m ..."
#   make trade    what accuracy costs: a table and plots (glint sweep)
#   make debian   packages, in clean systems;  check-debian: tools/debian
#   also: oiio assimp window inputs format golden-update fuzz-keep clean ward-sheet, and the tables that
#         tools/measure/recipes lists, all by make figures

# One job a processor, unless the command line has a -j of its own.
MAKEFLAGS += -r $(if $(filter 0,$(MAKELEVEL)),-j$(shell nproc))
.DEFAULT_GOAL := all
CONFIG ?= release
PREFIX ?= /usr/local
CPPFLAGS := -Iinclude -D_FILE_OFFSET_BITS=64
Q   := $(if $(V),,@)
say := @$(if $(V),:,printf ' %s %s\n')
include tools/make/target.mk

# Rooms of the sources; every file in them is built, but for the alternatives
# below. src/README.md states what each is for.
CORE      := base image kernels kernels/rays kernels/ward kernels/maps lens lamps follow tile flare/edges flare star veil scene scene/ward scene/motion scene/translucent scene/highlights scene/account reuse
ENGINE    := engine engine/options engine/frame engine/setup engine/star
BAKE      := bake bake/table bake/scene bake/environment bake/motion bake/translucent bake/trace bake/regress bake/visible bake/fit bake/skew bake/exact
PLATFORM  := posix formats video panel linux jpeg assimp sdl
TOOLS     := measure import synth glint $(addprefix glint/,help options control lamp_files desk model ffmpeg overlay zooms stones scenes motions lens_pages explain render live)
c_files = $(wildcard $(2:%=$(1)/%/*.c))
objects = $(patsubst %.c,$(OUT)/%.o,$(filter-out $(absent),$(call c_files,$(1),$(2))))

# What is not built in: kernels of other machines, the other half of a choice,
# main programs and plug-ins.
sets_x86_64 := sse41 avx2
sets_aarch64 := neon
sets_armv7 := neon
sets_armv7-neon := neon
sets_wasm32 := sse41
absent := $(foreach s,$(filter-out $(sets_$(ARCH)),sse41 avx2 x86 neon),$(wildcard src/kernels/*_$(s).c src/kernels/*/*_$(s).c))
absent += platform/jpeg/$(if $(filter yes,$(WITH_JPEG)),absent,mjpeg).c
absent += platform/formats/still_jpeg$(if $(filter yes,$(WITH_JPEG)),_absent).c platform/formats/still_png$(if $(filter yes,$(WITH_PNG)),_absent).c
absent += platform/formats/stills_absent.c
absent += src/bake/motion/$(if $(filter yes,$(WITH_JANSSON)),absent,recording).c
absent += $(if $(filter yes,$(WITH_JANSSON)),tools/synth/item_absent.c tools/import/json_absent.c,tools/synth/item_json.c tools/import/json.c)
absent += tools/import/$(if $(filter yes,$(WITH_EXPAT)),openlensflare_absent,openlensflare).c
# A static program has no plug-ins.
absent += platform/posix/$(if $(CROSS),plugin,plugin_absent).c platform/assimp/assimp.c platform/sdl/sdl.c
# WebAssembly has no threads.
absent += $(if $(filter wasm32,$(ARCH)),platform/posix/pool.c)
absent += tools/glint/glint.c tools/glint/glint_live.c tools/glint/model/models_only.c tools/glint/scenes/scenes_only.c tools/measure/insncount.c

core_o      := $(call objects,src,$(CORE))
# With the thread pool: of the platform the only file that is installed.
engine_o    := $(call objects,src,$(ENGINE)) $(filter %/pool.o,$(call objects,platform,posix))
bake_o      := $(call objects,src,$(BAKE))
platform_o  := $(filter-out $(engine_o),$(call objects,platform,$(PLATFORM)))
tools_o     := $(call objects,tools,$(TOOLS))
measure_o   := $(call objects,tools,measure/glint-measure)
main_o      := $(patsubst %,$(OUT)/tools/glint/%.o,glint glint_live model/models_only scenes/scenes_only)
LDLIBS := $(if $(filter yes,$(WITH_JPEG)),$(JPEG_LIBS)) $(if $(filter yes,$(WITH_PNG)),$(PNG_LIBS)) \
        $(if $(filter yes,$(WITH_JANSSON)),$(JANSSON_LIBS)) $(if $(filter yes,$(WITH_EXPAT)),$(EXPAT_LIBS)) -lm -lpthread -ldl
include tools/make/flags.mk

$(OUT)/%.o: %.c
	@mkdir -p $(@D)
	$(say) CC $<
	$(if $(NOTE),@echo ' $(NOTE)')
	$(TIDY)
	$(Q)$(CC) $(CPPFLAGS) -MMD -MP $(CFLAGS) $(ANALYZER) -c $< -o $@
$(OUT)/platform/jpeg/absent.o: NOTE := MJPEG and JPEG left out: no libjpeg62-turbo-dev
$(OUT)/platform/formats/still_png_absent.o: NOTE := PNG left out: no libpng-dev
$(OUT)/tools/synth/item_absent.o: NOTE := synth --item left out: no libjansson-dev
$(OUT)/tools/import/json_absent.o: NOTE := lens files of realflare and lentil left out: no libjansson-dev
$(OUT)/src/bake/motion/absent.o: NOTE := recordings left out: no libjansson-dev

$(OUT)/libglint.a: $(core_o)
$(OUT)/libglint-engine.a: $(engine_o)
$(OUT)/libglint-bake.a: $(bake_o)
$(OUT)/libglint-platform.a: $(platform_o)
$(OUT)/libglint-tools.a: $(tools_o)
$(OUT)/lib%.a:
	$(say) AR $@
	$(Q)rm -f $@; $(AR) rcs $@ $(filter %.o,$^)
# Archives are rebuilt where other files are to be in them, and what knows the
# prefix where that is another.
archives := $(patsubst %,$(OUT)/libglint%.a,-tools -platform -bake -engine) $(OUT)/libglint.a
$(archives): $(OUT)/parts
$(OUT)/parts: parts := $(core_o) $(engine_o) $(bake_o) $(platform_o) $(tools_o)
$(OUT)/prefix: parts := $(PREFIX) $(LIBDIR)
$(OUT)/parts $(OUT)/prefix: always
	@mkdir -p $(@D); echo '$(parts)' | cmp -s - $@ || echo '$(parts)' >$@
$(OUT)/tools/glint/model/lens_files.o $(OUT)/platform/posix/plugin.o: $(OUT)/prefix
libs := $(archives)

define link
	@mkdir -p $(@D)
	$(say) LD $@
	$(Q)$(CC) $(CFLAGS) $(LINKED) $(LDFLAGS) $(filter %.o,$^) $(libs) $(EXTRA) \
	        $(LDLIBS) -o $@.$$$$ && mv -f $@.$$$$ $@
endef

# The comment that this file begins with.
help:
	@sed -n '2,/^$$/s/^# \{0,1\}//p' $(firstword $(MAKEFILE_LIST))
all: $(if $(CROSS),$(OUT)/glint,build/glint)
build/glint: $(OUT)/glint always
	$(Q)cmp -s $< $@ || { cp -f $< $@.tmp && mv -f $@.tmp $@; }
always:
$(OUT)/glint: $(OUT)/tools/glint/glint.o $(libs)
	$(link)

# The program that measures figures; not installed.
$(OUT)/glint-measure: $(measure_o) $(libs)
	$(link)

# Programs that take one part of the run-time library, and no other half.
EXAMPLES := ghost_rays add_glow find_lamps draw_flare draw_scene
example_bins := $(EXAMPLES:%=$(OUT)/examples/%)
$(example_bins): $(OUT)/examples/%: $(OUT)/tools/examples/%.o $(OUT)/libglint.a
	@mkdir -p $(@D)
	$(say) LD $@
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -Wl,--gc-sections,-Map=$@.map $^ -lm -o $@

# Programs that embed the engine: for lens tables and models; for models alone,
# without the offline half; the first of these as C++; and with a scene.
embed_bins := $(addprefix $(OUT)/examples/,embed embed_models embed_cxx embed_scene)
embed_libs := $(OUT)/libglint-engine.a $(OUT)/libglint.a
$(OUT)/examples/embed $(OUT)/examples/embed_cxx: $(OUT)/libglint-bake.a
$(filter-out %_scene,$(embed_bins)): tools/examples/embed.c
$(OUT)/examples/embed_scene: tools/examples/embed_scene.c
$(embed_bins): $(embed_libs)
	@mkdir -p $(@D)
	$(say) LD $@
	$(Q)$(embed_$(@F)) $(CPPFLAGS) $(filter-out -std=% -Wstrict-prototypes -Wmissing-prototypes,$(CFLAGS)) \
	        $(filter %.c,$^) -x none $(LDFLAGS) $(filter %-bake.a,$^) $(embed_libs) -lm -o $@
embed_embed        = $(CC) -std=c99
embed_embed_models = $(CC) -std=c99 -DEMBED_MODELS
embed_embed_scene  = $(CC) -std=c99 -D_POSIX_C_SOURCE=200809L
embed_embed_cxx    = $(if $(findstring clang,$(CC)),clang++,$(CXX)) -std=c++17 -x c++

# The live command alone, for baked models, stripped.
glint-live: $(OUT)/glint-live
$(OUT)/glint-live: LDFLAGS += $(if $(filter yes,$(STRIP)),-s) -Wl,--gc-sections,--as-needed
$(OUT)/glint-live: $(OUT)/tools/glint/glint_live.o $(OUT)/tools/glint/model/models_only.o $(OUT)/tools/glint/scenes/scenes_only.o \
        $(OUT)/platform/formats/stills_absent.o $(libs)
	$(link)

# The image plug-in, the only C++: PNG, JPEG, EXR ... through OpenImageIO.
oiio: build/glint-oiio.so
OIIO := $(wildcard platform/oiio/*.cc)
build/glint-oiio.so: $(OIIO) $(wildcard platform/oiio/*.h) $(addprefix platform/formats/,oiio.h samples.h tones.h)
	@mkdir -p $(@D)
	$(say) CXX '$(OIIO)'
	$(Q)$(CXX) -std=c++17 -Wall -Wextra $(PLUGGED) -Iinclude -Iplatform \
	        $(OIIO) -o $@ $$(pkg-config --cflags --libs OpenImageIO) \
	        $$(pkg-config --exists libwebp && pkg-config --cflags --libs libwebp) \
	        $$(pkg-config --exists libheif && pkg-config --cflags --libs libheif) \
	        $$(pkg-config --exists lcms2 libjpeg && pkg-config --cflags --libs lcms2 libjpeg)

# The mesh plug-in: PLY, STL, glTF ... through Open Asset Import.
assimp: build/glint-assimp.so
build/glint-assimp.so: platform/assimp/assimp.c platform/assimp/assimp.h
	@mkdir -p $(@D)
	$(say) CC $<
	$(Q)$(CC) -std=c99 $(filter-out -Wundef -Wpedantic -Wstrict-prototypes,$(WARN)) -D_POSIX_C_SOURCE=200809L \
	        $(PLUGGED) -Iinclude -Iplatform $< -o $@ $$(pkg-config --cflags --libs assimp)

# The window of glint live -o window, through SDL2.
window: build/glint-sdl.so
build/glint-sdl.so: platform/sdl/sdl.c platform/sdl/sdl.h
	@mkdir -p $(@D)
	$(say) CC $<
	$(Q)$(CC) -std=c99 $(filter-out -Wundef,$(WARN)) $(PLUGGED) -Iinclude -Iplatform \
	        $< -o $@ $$(pkg-config --cflags --libs sdl2)

include tools/make/hosts.mk tools/make/web.mk tools/make/man.mk tools/make/check.mk tools/make/emulated.mk tools/make/measure.mk tools/make/shared.mk tools/make/install.mk tools/make/debian.mk
clean:
	rm -rf build
.PHONY: all help always oiio assimp window glint-live clean
-include $(shell find $(OUT) -name '*.d' 2>/dev/null)
