# glint - physically based camera effects for small machines.
#
#   make          build/glint and the libraries; needs a C compiler only
#   make demo     overlays ghosts on a real photograph and a video
#   make check    every test;  CONFIG=release|asan|tsan|qcheck  CC=gcc|clang
#   make lint     layers, Q formats, formatting, symbols, purity

MAKEFLAGS += -r
.DEFAULT_GOAL := all
CONFIG ?= release
ifeq ($(origin CC),default)
CC := gcc
endif
AR ?= ar
NM ?= nm
ARCH := $(firstword $(subst -, ,$(shell $(CC) -dumpmachine)))
OUT  := build/$(ARCH)-$(notdir $(CC))-$(CONFIG)

# Sources in the order the data flows.
CORE := base/status base/arena base/q base/image base/workers \
        flare/lights flare/ghost_grid tile/primitive tile/clip tile/bins \
        tile/raster tile/transfer tile/resolve flare/flare
BAKE := bake/text bake/prescription bake/glass bake/coating bake/paraxial \
        bake/ghosts bake/trace bake/pupil bake/cells bake/setup bake/exact \
        bake/feed
PLATFORM := posix/error posix/input posix/output posix/workers plain/pnm \
        plain/pfm plain/y4m oiio/loader plain/picture
TOOLS := glint tool measure frame scene cmd_info cmd_trace cmd_render \
         cmd_overlay cmd_compare

have = $(foreach f,$(2),$(if $(wildcard $(1)/$(f).c),$(OUT)/$(1)/$(f).o))
core_o     := $(call have,src,$(CORE))
bake_o     := $(call have,src,$(BAKE))
platform_o := $(call have,platform,$(PLATFORM))
tools_o    := $(call have,tools,$(TOOLS))

CPPFLAGS := -Iinclude
CFLAGS := -std=c99 -O2 -g -ffp-contract=off -fvisibility=hidden -Wall -Wextra \
          -Wpedantic -Wconversion -Wshadow -Wstrict-prototypes \
          -Wmissing-prototypes -Wvla -Wdouble-promotion -Wundef -Werror
LDLIBS := -lm
$(OUT)/src/%.o $(OUT)/tests/%.o: CPPFLAGS += -Isrc
$(OUT)/platform/%.o $(OUT)/tools/%.o $(OUT)/tests/%.o: \
        CPPFLAGS += -Iplatform -D_POSIX_C_SOURCE=200809L
$(core_o): CFLAGS += -Wframe-larger-than=1024 -ffreestanding
ifeq ($(CONFIG),asan)
CFLAGS += -O1 -fsanitize=address,undefined -fno-sanitize-recover=all
else ifeq ($(CONFIG),tsan)
CFLAGS += -O1 -fsanitize=thread
else ifeq ($(CONFIG),qcheck)
CPPFLAGS += -DGLINT_Q_CHECK
endif

$(OUT)/%.o: %.c
	@mkdir -p $(@D)
	$(say) CC $<
	$(Q)$(CC) $(CPPFLAGS) -MMD -MP $(CFLAGS) -c $< -o $@

$(OUT)/libglint.a: $(core_o)
$(OUT)/libglint-bake.a: $(bake_o)
$(OUT)/libglint-platform.a: $(platform_o)
$(OUT)/lib%.a:
	$(say) AR $@
	$(Q)rm -f $@; $(AR) rcs $@ $^
libs := $(OUT)/libglint-platform.a $(OUT)/libglint-bake.a $(OUT)/libglint.a

all: build/glint
build/glint: $(OUT)/glint
	@cp -f $< $@
$(OUT)/glint: $(tools_o) $(libs)
	$(say) LD $@
	$(Q)$(CC) $(CFLAGS) $(tools_o) $(libs) $(LDLIBS) -lpthread -ldl -o $@

unit := $(patsubst tests/unit/%.c,%,$(wildcard tests/unit/*.c))
$(OUT)/tests/unit/%: $(OUT)/tests/unit/%.o $(libs)
	$(say) LD $@
	$(Q)$(CC) $(CFLAGS) $< $(libs) -lcmocka $(LDLIBS) -lpthread -ldl -o $@
unit: $(unit:%=$(OUT)/tests/unit/%)
	@for t in $^; do $$t || exit 1; done

clean:
	rm -rf build
.PHONY: all unit clean
.SECONDARY:
Q   := $(if $(V),,@)
say := @$(if $(V),:,printf ' %s %s\n')
-include $(shell find $(OUT) -name '*.d' 2>/dev/null)
