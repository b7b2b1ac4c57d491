# Plug-ins for hosts of others. Like shared libraries they are made of objects in
# a folder of their own, and contain all that they take of glint.

filter_o := $(patsubst %.c,$(OUT)/%.o,$(wildcard tools/hosts/filter/*.c))
frei0r_o := $(patsubst %.c,$(OUT)/%.o,$(wildcard tools/hosts/frei0r/*.c)) $(filter_o)
gstreamer_o := $(patsubst %.c,$(OUT)/%.o,$(wildcard tools/hosts/gstreamer/*.c)) $(filter_o)
obs_o := $(patsubst %.c,$(OUT)/%.o,$(wildcard tools/hosts/obs/*.c)) $(filter_o)
plugins := frei0r gstreamer obs
placed_frei0r    := build/glint-frei0r.so
placed_gstreamer := build/gstreamer-1.0/libgstglint.so
placed_obs       := build/obs-plugins/glint.so
$(OUT)/glint-frei0r.so: $(frei0r_o)
GSTREAMER := gstreamer-video-1.0 gstreamer-1.0
$(OUT)/glint-gstreamer.so: $(gstreamer_o)
$(OUT)/glint-gstreamer.so: EXTRA = $$(pkg-config --libs $(GSTREAMER))
# Headers of others do not keep to our warnings.
$(OUT)/tools/hosts/gstreamer/%.o: CPPFLAGS += $(shell pkg-config --cflags $(GSTREAMER) 2>/dev/null | sed 's/-I/-isystem /g')
$(OUT)/glint-obs.so: $(obs_o)
$(OUT)/glint-obs.so: EXTRA = $$(pkg-config --libs libobs)
$(OUT)/tools/hosts/obs/%.o: CPPFLAGS += $(shell pkg-config --cflags libobs 2>/dev/null | sed 's/-I/-isystem /g')
# A host may drop the plug-in while a signal's action still points into it.
$(plugins:%=$(OUT)/glint-%.so): $(archives)
	@mkdir -p $(@D)
	$(say) LD $@
	$(Q)$(CC) $(CFLAGS) -shared $(filter -Wl%,$(LINKED)) $(LDFLAGS) -Wl,--exclude-libs,ALL \
	        -Wl,--version-script=tools/hosts/$(@:$(OUT)/glint-%.so=%)/exports.map -Wl,-z,defs,-z,nodelete -Wl,--gc-sections \
	        $(filter %.o,$^) $(libs) $(EXTRA) $(LDLIBS) -o $@
ifdef PIC
$(plugins): %: $(OUT)/glint-%.so
	@mkdir -p $(dir $(placed_$@))
	$(Q)cp -f $< $(placed_$@).tmp && mv -f $(placed_$@).tmp $(placed_$@)
else
$(plugins):
	@$(MAKE) --no-print-directory PIC=yes $@
gstreamer obs: | $(filter frei0r,$(MAKECMDGOALS)) # they share archives
endif
# Eight instances at once, watched by ThreadSanitizer.
check-frei0r-threads:
	@$(MAKE) --no-print-directory CONFIG=tsan PIC=yes run-frei0r-threads
run-frei0r-threads: $(OUT)/glint-frei0r.so $(OUT)/frei0r_host
	@head -c 737280 tests/data/bridge.ppm | XDG_CACHE_HOME=$$PWD/build/cache GLINT_LENSES=$$PWD/lenses \
	        TSAN_OPTIONS=exitcode=9 $(OUT)/frei0r_host $< 192x120 8 quality=.25 gain@3=.3 lens@4=heliar-tronnier >$(OUT)/frames
	@echo '8 instances at once: no race'
.PHONY: $(plugins) check-frei0r-threads run-frei0r-threads

# A host of our own, for tests.
$(OUT)/frei0r_host: $(OUT)/tests/hosts/frei0r_host.o
	@mkdir -p $(@D)
	$(say) LD $@
	$(Q)$(CC) $(CFLAGS) $(LINKED) $(LDFLAGS) $^ -lpthread -ldl -o $@

# The harness that GStreamer has for tests of elements.
$(OUT)/tests/hosts/gst_harness.o: CPPFLAGS += $(shell pkg-config --cflags gstreamer-check-1.0 2>/dev/null | sed 's/-I/-isystem /g')
$(OUT)/gst_harness: $(OUT)/tests/hosts/gst_harness.o
	@mkdir -p $(@D)
	$(say) LD $@
	$(Q)$(CC) $(CFLAGS) $(LINKED) $(LDFLAGS) $^ $$(pkg-config --libs gstreamer-check-1.0) -o $@
check-gstreamer:
	@tools/make/deps "the element of GStreamer" gcc pkg-config libgstreamer1.0-dev libgstreamer-plugins-base1.0-dev \
	        libgstreamer-plugins-bad1.0-dev gstreamer1.0-tools gstreamer1.0-plugins-base gstreamer1.0-plugins-bad
	@$(MAKE) --no-print-directory all
	@tests/hosts/gstreamer $(OUT)
.PHONY: check-gstreamer

# A host of libobs.
$(OUT)/tests/hosts/obs_host.o: CPPFLAGS += -D_DEFAULT_SOURCE $(shell pkg-config --cflags libobs 2>/dev/null | sed 's/-I/-isystem /g')
$(OUT)/obs_host: $(OUT)/tests/hosts/obs_host.o
	@mkdir -p $(@D)
	$(say) LD $@
	$(Q)$(CC) $(CFLAGS) $(LINKED) $(LDFLAGS) $^ $$(pkg-config --libs libobs) -lpthread -o $@
check-obs:
	@tools/make/deps "the filter of OBS" gcc pkg-config libobs-dev obs-studio xvfb xauth libgl1-mesa-dri libegl-mesa0
	@$(MAKE) --no-print-directory all
	@tests/hosts/obs $(OUT)
.PHONY: check-obs

# For tools/hosts/python: what its module is linked with, and the folder of archives.
print-out:
	@echo '$(taken)' $(OUT)
# The Python package, in an environment of its own.
check-python:
	@tools/make/deps "the Python package" gcc python3-cffi python3-numpy python3-setuptools python3-wheel python3-venv python3-pip
	@tests/hosts/python
.PHONY: print-out check-python

# Data sets by GNU parallel over ssh, a Slurm array and Dask, on clusters of their own;
# a video by GNU parallel.
check-spread: build/glint $(OUT)/pan
	@tools/make/deps "data sets on many machines" parallel openssh-server openssh-client slurm-wlm munge python3-distributed
	@GLINT=build/glint PAN=$(OUT)/pan XDG_CACHE_HOME=$$PWD/build/cache tests/hosts/spread
.PHONY: check-spread

# What items of data sets cost, and their bytes; COUNT=10000 takes a day of a processor.
synth-table: all
	@tools/measure/synth/synth-table $(or $(COUNT),100) | tools/measure/write-figures synth/items
# A remover of ghosts that learns from a data set: some twenty minutes of a processor.
synth-baseline: all
	@tools/make/deps "photographs, and a network that learns" imagemagick python3-pil python3-numpy npm \
	        python3-torch >&2
	@tools/synth/baseline/all | tools/measure/write-figures synth/baseline
.PHONY: synth-table synth-baseline

# Every command that READMEs and manual pages name, those that take minutes, too.
check-commands:
	@tools/make/deps "the commands that READMEs name" gcc g++ pkg-config libopenimageio-dev libassimp-dev ffmpeg
	@$(MAKE) --no-print-directory all oiio frei0r man
	@tests/hosts/commands --all
.PHONY: check-commands
