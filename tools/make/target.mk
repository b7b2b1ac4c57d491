# What is built for: the machine, its compiler, and the libraries that glint can
# do without.

ifeq ($(origin CC),default)
CC := gcc
endif
CXX     := g++
AR      ?= ar
NM      ?= nm
SIZE    ?= size
OBJDUMP ?= objdump
# Of packages: libraries go to a folder of the machine's kind, and what strips
# programs is not the Makefile (STRIP=no).
LIBDIR  ?= $(PREFIX)/lib
STRIP   ?= yes
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
PNG_CPPFLAGS := $(SYSROOT:%=-isystem %/include)
PNG_LIBS     := $(SYSROOT:%=-L%/lib) -lpng -lz -lm
JANSSON_CPPFLAGS := $(SYSROOT:%=-isystem %/include)
JANSSON_LIBS     := $(SYSROOT:%=-L%/lib) -ljansson
EXPAT_CPPFLAGS := $(SYSROOT:%=-isystem %/include)
EXPAT_LIBS     := $(SYSROOT:%=-L%/lib) -lexpat
endif
ARCH := $(if $(CROSS),$(TARGET),$(firstword $(subst -, ,$(shell $(CC) -dumpmachine))))
ifeq ($(ARCH),arm) # of which there are many
ARCH := $(shell $(CC) -dM -E -x c /dev/null | \
        awk '$$2 == "__ARM_ARCH" { print $$3 < 7 ? "armv6" : "armv7" }')
endif
OUT  := build/$(if $(CROSS),$(TARGET)$(if $(DYNAMIC),-dynamic),$(ARCH)-$(notdir $(CC))-$(CONFIG))$(if $(PIC),-pic)
export DEPS OUT

# Libraries that glint can do without:  WITH_JPEG=yes|no  states which are used,
# else it is whether a program with them can be built. Argument 4 of has is a
# function that the header must declare.
has = $(shell printf '\043include <stdio.h>\n\043include <%s>\nint main(void) { return !($(or $(4),1)); }\n' $(1) | \
        $(CC) $(CPPFLAGS) $(2) -x c - $(LDFLAGS) $(3) -o /dev/null 2>/dev/null && echo yes || echo no)
JPEG_LIBS ?= -ljpeg
ifndef WITH_JPEG # of libjpeg-turbo; IJG's libjpeg cannot read ICC profiles
WITH_JPEG := $(call has,jpeglib.h,$(JPEG_CPPFLAGS),$(JPEG_LIBS),jpeg_read_icc_profile)
endif
PNG_LIBS ?= -lpng
ifndef WITH_PNG
WITH_PNG := $(call has,png.h,$(PNG_CPPFLAGS),$(PNG_LIBS))
endif
JANSSON_LIBS ?= -ljansson
ifndef WITH_JANSSON
WITH_JANSSON := $(call has,jansson.h,$(JANSSON_CPPFLAGS),$(JANSSON_LIBS))
endif
EXPAT_LIBS ?= -lexpat
ifndef WITH_EXPAT
WITH_EXPAT := $(call has,expat.h,$(EXPAT_CPPFLAGS),$(EXPAT_LIBS))
endif
