# Tests, sanitizers, analysis.

# What tests share; fakes answer calls of those alone that want them.
$(OUT)/libglint-tests.a: $(patsubst %.c,$(OUT)/%.o,$(wildcard tests/support/*.c tests/support/models/*.c tests/support/stars/*.c tests/support/tracks/*.c))

# Methods as the literature has them, and renderers in double precision, that tests
# compare glint with.
reference_a := $(OUT)/libglint-reference.a
$(reference_a): $(patsubst %.c,$(OUT)/%.o,$(filter-out $(wildcard tests/reference/*/test_*.c),$(wildcard tests/reference/*/*.c)))

# Unit tests, each a program: tests/unit/ROOM/test_NAME.c, or test_NAME.c of
# tests/reference, is OUT/tests/unit/test_NAME.
EXTREMES := $(patsubst tests/unit/props/test_extremes_%.c,%,$(wildcard tests/unit/props/test_extremes_*.c))
unit_c := $(wildcard tests/unit/*/test_*.c tests/reference/*/test_*.c)
unit_c := $(filter-out %/test_mjpeg$(if $(filter yes,$(WITH_JPEG)),_absent).c \
        $(if $(filter yes,$(WITH_JANSSON)),,%/test_recording.c),$(unit_c))
UNIT := $(patsubst test_%,%,$(basename $(notdir $(unit_c))))
ifeq ($(CONFIG),tsan) # what starts threads or is interrupted by signals
UNIT := $(filter bake exact flare flare_light flare_room output at_death frame live pool,$(UNIT))
endif
FUZZERS := $(filter-out $(if $(filter yes,$(WITH_JPEG)),,mjpeg) \
        $(if $(filter yes,$(WITH_JANSSON)),,recording) \
        $(if $(filter yesyes,$(WITH_JPEG)$(WITH_PNG)),,stills), \
        $(patsubst tests/fuzz/fuzz_%.c,%,$(wildcard tests/fuzz/fuzz_*.c)))
test_bins := $(UNIT:%=$(OUT)/tests/unit/test_%)
$(test_bins): EXTRA := $(SYSROOT:%=-L%/lib) -lcmocka
ifdef CROSS # of which Debian has a shared library only
$(OUT)/tests/%.o: CPPFLAGS += $(SYSROOT:%=-isystem %/include)
$(test_bins): LDFLAGS := $(filter-out -static,$(LDFLAGS))
endif
# Calls that tests answer themselves, or let fail.
$(OUT)/tests/unit/test_fbdev: LDFLAGS += -Wl,--wrap=open64,--wrap=ioctl \
        -Wl,--wrap=mmap64,--wrap=munmap,--wrap=malloc
FAKE_DISPLAY := open64 close ioctl mmap64 munmap poll read
$(OUT)/tests/unit/test_kms: LDFLAGS += $(FAKE_DISPLAY:%=-Wl,--wrap=%)
$(OUT)/tests/unit/test_output: LDFLAGS += -Wl,--wrap=close
$(OUT)/tests/unit/test_output_together: LDFLAGS += -Wl,--wrap=realpath
$(OUT)/tests/unit/test_pool: LDFLAGS += -Wl,--wrap=pthread_create
$(OUT)/tests/unit/test_flare_room: LDFLAGS += -Wl,--wrap=glint_edges_bin
$(OUT)/tests/unit/test_sinks: LDFLAGS += -Wl,--wrap=ioctl,--wrap=write
FAKE_CAMERA := ioctl open64 stat64 close read mmap64 munmap malloc calloc \
        realloc posix_memalign free strdup realpath clock_gettime nanosleep glint_mjpeg_available
fake_bins := $(patsubst %,$(OUT)/tests/unit/test_%,v4l2 v4l2_faults live)
$(OUT)/tests/unit/test_live: LDFLAGS += -Wl,--wrap=ppoll
$(OUT)/tests/unit/test_frame: LDFLAGS += -Wl,--wrap=malloc,--wrap=calloc \
        -Wl,--wrap=realloc,--wrap=posix_memalign
$(OUT)/tests/unit/test_budget $(OUT)/tests/unit/test_scene_budget: LDFLAGS += \
        -Wl,--wrap=tool_clock_s
$(fake_bins): LDFLAGS += $(FAKE_CAMERA:%=-Wl,--wrap=%)
$(fake_bins): $(OUT)/tests/support/fakes/fake_camera.o
$(OUT)/tests/unit/test_fbdev: $(OUT)/tests/support/fakes/fake_fb.o
extreme_bins := $(EXTREMES:%=$(OUT)/tests/unit/test_extremes_%)
$(foreach c,$(unit_c),$(eval $(OUT)/tests/unit/$(notdir $(basename $(c))): $(OUT)/$(c:.c=.o)))
$(test_bins): $(OUT)/libglint-tests.a $(reference_a) $(libs)
	$(link)
replay_bins := $(FUZZERS:%=$(OUT)/tests/fuzz/replay_%)
$(replay_bins): $(OUT)/tests/fuzz/replay_%: $(OUT)/tests/fuzz/fuzz_%.o \
        $(OUT)/tests/fuzz/replay.o $(libs)
	$(link)
# Programs of tests, for tables and long runs: tests/programs/NAME.c is OUT/NAME.
PROGRAMS := $(patsubst tests/programs/%.c,$(OUT)/%,$(wildcard tests/programs/*.c))
hostile_models := $(OUT)/hostile_models # writes models that tests/cli/hostile draws
$(test_bins) $(PROGRAMS) $(hostile_models): libs := $(OUT)/libglint-tests.a $(reference_a) $(archives)
$(PROGRAMS): $(OUT)/%: $(OUT)/tests/programs/%.o $(OUT)/libglint-tests.a $(reference_a) $(libs)
	$(link)
$(hostile_models): $(OUT)/%: $(OUT)/tests/fuzz/%.o $(OUT)/libglint-tests.a $(reference_a) $(libs)
	$(link)

CHECK_PACKAGES := gcc libc6-dev binutils libcmocka-dev clang clang-format pkg-config \
        libjpeg62-turbo-dev libpng-dev libjansson-dev libexpat1-dev python3
check:
	@tools/make/deps "unit tests, lint" $(CHECK_PACKAGES)
	@$(MAKE) --no-print-directory WERROR=-Werror run-check
run-check: lint $(test_bins) $(replay_bins) $(OUT)/glint $(OUT)/glint-measure $(example_bins) $(embed_bins) \
        $(PROGRAMS) $(hostile_models) $(wildcard build/glint-oiio.so build/glint-assimp.so)
	@[ $(notdir $(CC))-$(CONFIG) != gcc-release ] || { $(MAKE) --no-print-directory PIC=yes shared frei0r && $(MAKE) --no-print-directory man check-symbols; }
	@GLINT_QUICK=$(filter asan tsan,$(CONFIG)) tests/run $(test_bins) -- \
	        $(replay_bins)
	@[ -n "$(filter asan tsan,$(CONFIG))" ] || tests/extremes --quick
# One test by its name, its file or its program, with all that it prints:
# make test TEST=flare   TEST=cli/overlay   TEST=replay_lens
test_bin := $(if $(TEST),$(filter %/$(TEST) %/test_$(TEST),$(test_bins)))
replay_bin := $(if $(TEST),$(filter %/$(TEST),$(replay_bins)))
scripts := $(shell find tests/cli tests/hosts -type f -perm /1) tests/links tests/embed tests/library
test_script := $(if $(TEST)$(test_bin)$(replay_bin),$(firstword $(filter $(TEST) tests/$(TEST) %/$(TEST),$(scripts))))
test_script := $(if $(test_bin)$(replay_bin),,$(test_script))
test:
	@tools/make/deps "unit tests" $(CHECK_PACKAGES)
	@$(MAKE) --no-print-directory run-test
run-test: $(test_bin) $(replay_bin) $(if $(test_script),$(OUT)/glint $(OUT)/glint-measure $(OUT)/pan $(OUT)/scene_exact $(hostile_models) $(example_bins) $(embed_bins))
	@[ -n "$^" ] || { echo 'TEST is one of these, or a file in tests/cli or tests/hosts:' $(UNIT) $(notdir $(replay_bins)) >&2; exit 2; }
	@GLINT_QUICK=$(filter asan tsan,$(CONFIG)) tests/run -v $(test_bin) -- $(replay_bin) -- $(test_script)
# What a release must pass; durations stand in tests/README.md.
check-all:
	@set -e; for how in "" CC=clang CONFIG=asan CONFIG=tsan CONFIG=qcheck; do \
	        $(MAKE) --no-print-directory check $$how; done; \
	for what in demo analyze check-valgrind check-arm check-vm check-commands check-options check-files check-web check-allocations check-growth check-obs check-debian mutants; do \
	        $(MAKE) --no-print-directory $$what; done
	@$(MAKE) --no-print-directory fuzz RUNS=10000
# What other programs find in files that overlay has written.
check-files:
	@tools/make/deps "picture files as other programs see them" g++ pkg-config libopenimageio-dev \
	        libwebp-dev libheif-dev libheif-examples liblcms2-dev libjpeg62-turbo-dev openimageio-tools libimage-exiftool-perl imagemagick ffmpeg
	@$(MAKE) --no-print-directory all oiio
	@GLINT=build/glint GLINT_OIIO=build/glint-oiio.so tests/cli/files
	@GLINT=build/glint tests/cli/video
	@tests/install
# Each request for memory of each command fails once; prints a table.
check-allocations: $(OUT)/glint
	@GLINT=$< tests/cli/allocations --all
# What each reader costs for an input and for twice as much; prints a table.
check-growth: $(replay_bins)
	@tools/make/deps "counts of instructions" valgrind
	@OUT=$(OUT) tests/fuzz/growth $(READER)
# Random command lines: RUNS=10000 of them from SEED=1.
check-options: $(OUT)/glint
	@GLINT=$< tests/fuzz/options $(or $(RUNS),10000) $(or $(SEED),1)
# Long cases and random lenses too:  make extremes SEED=1 COUNT=500
extremes: $(extreme_bins) $(OUT)/random_lenses $(OUT)/motion
	@tests/extremes $(SEED:%=--seed %) $(COUNT:%=--count %)
# Faults planted in copies of the tree: MUTANTS=names, or all.
mutants:
	@tools/make/deps "unit tests" $(CHECK_PACKAGES)
	@$(MAKE) --no-print-directory run-mutants
run-mutants: $(test_bins)
	@tests/mutants/run $(OUT) $(MUTANTS)
# What valgrind says of memory that was never written, which no sanitizer of
# gcc's does: the run-time half, what reads files, and the fuzzers' corpora.
VALGRIND := $(filter arena kernels model transfer curve resolve lamp_finder flare flare_light flare_room window plan lights pnm y4m \
        picture bright match lamps mjpeg config prescription trace,$(UNIT))
check-valgrind:
	@tools/make/deps "memory checks" gcc libc6-dev valgrind libcmocka-dev \
	        libjpeg62-turbo-dev libpng-dev libjansson-dev libexpat1-dev
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
golden-update: $(OUT)/tests/unit/test_flare
	@GLINT_GOLDEN_UPDATE=1 $<

# Every fuzzer for SECONDS or RUNS, or one:  make fuzz FUZZ=lens SECONDS=600. What they
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
	@tools/make/deps "libFuzzer" clang libclang-rt-14-dev
	@$(MAKE) --no-print-directory CC=clang CONFIG=fuzz run-$@
run-fuzz run-fuzz-keep: $(fuzz_bins)
	@tests/fuzz/run $(@:run-%=%) $(SECONDS) $^

# Static analysis, of what has changed since the last time.
analyze:
	@tools/make/deps "static analysis" gcc clang-tidy cppcheck
	@$(MAKE) --no-print-directory CC=gcc CONFIG=analyze WERROR=-Werror run-analyze
run-analyze: $(core_o) $(engine_o) $(bake_o) $(platform_o) $(tools_o) $(measure_o) $(frei0r_o) $(if $(filter %,$(shell pkg-config --modversion gstreamer-video-1.0 2>/dev/null)),$(gstreamer_o)) $(if $(filter %,$(shell pkg-config --modversion libobs 2>/dev/null)),$(obs_o)) $(OUT)/tools/glint/glint.o
	$(say) CPPCHECK 'src platform tools'
	@mkdir -p $(OUT)/cppcheck
	$(Q)cppcheck -q --std=c99 --language=c --error-exitcode=1 \
	        --enable=warning,performance,portability,style --inline-suppr \
	        --suppressions-list=tools/lint/cppcheck-suppressions \
	        --cppcheck-build-dir=$(OUT)/cppcheck -Iinclude -Isrc -Iplatform -Itools -Itools/glint -Itools/hosts \
	        -D__x86_64__ -D__GNUC__ -D_POSIX_C_SOURCE=200809L \
	        $(patsubst $(OUT)/%.o,%.c,$(filter %.o,$^))

sources = $(shell find include src platform tools tests -name '*.[ch]' -o -name '*.inc')
format:
	$(Q)clang-format -i $(sources)
libraries := $(OUT)/libglint.a
# The main programs, too, but not the files that replace others in them.
all_o := $(core_o) $(engine_o) $(bake_o) $(platform_o) $(tools_o) $(filter-out %_only.o,$(main_o))
lint: $(libraries) $(OUT)/libglint-engine.a $(OUT)/libglint-bake.a $(all_o)
	@tools/lint/layers && tools/lint/cycles $(NM) $(OUT) $(all_o) && tools/lint/tags && tools/lint/q && tools/lint/length && tools/lint/links && tools/lint/prose && tests/mutants/run --check && tools/measure/write-figures --check
	@tools/lint/symbols $(NM) $(filter %.a,$^)
	@[ $(CONFIG) != release ] || \
	        $(MAKE) -s --no-print-directory purity
	@clang-format --dry-run -Werror $(sources)
	@for h in include/glint/*.h include/glint/*/*.h; do \
	        $(CC) -Iinclude -std=c99 -Wall -Wno-unused-function -Wpedantic -Werror -fsyntax-only -x c $$h || exit 1; \
	        ! command -v $(CXX) >/dev/null || \
	        $(CXX) -Iinclude -std=c++17 -Wall -Wno-unused-function -Wpedantic -Werror -fsyntax-only -x c++ $$h || exit 1; done

# Of the objects alone, so for machines that cannot be run here, too.
# The program for boards reads and writes files besides.
board_o := $(OUT)/tools/examples/draw_flare.o
board_calls := stdout stderr fopen fopen64 fread ferror fclose fwrite fflush fprintf strtol atoi
purity: $(libraries) $(board_o)
	@tools/lint/purity $(NM) $(OBJDUMP) $(libraries)
	@tools/lint/purity --calls '$(board_calls)' $(NM) $(OBJDUMP) $(board_o) $(OUT)/libglint.a


.PHONY: check run-check test run-test check-files check-allocations check-growth check-options check-all extremes mutants run-mutants check-valgrind run-valgrind golden-update \
        fuzz fuzz-keep run-fuzz run-fuzz-keep analyze run-analyze format lint purity
