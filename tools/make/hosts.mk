# Plug-ins for hosts of others. Like shared libraries they are made of objects in
# a folder of their own, and contain all that they take of glint.

frei0r_o := $(patsubst %.c,$(OUT)/%.o,$(wildcard tools/frei0r/*.c))
# A host may drop the plug-in while a signal's action still points into it.
$(OUT)/glint-frei0r.so: $(frei0r_o) $(archives)
	@mkdir -p $(@D)
	$(say) LD $@
	$(Q)$(CC) $(CFLAGS) -shared $(filter -Wl%,$(LINKED)) $(LDFLAGS) -Wl,--exclude-libs,ALL \
	        -Wl,--version-script=tools/frei0r/exports.map -Wl,-z,defs,-z,nodelete -Wl,--gc-sections \
	        $(filter %.o,$^) $(libs) $(LDLIBS) -o $@
ifdef PIC
frei0r: $(OUT)/glint-frei0r.so
	$(Q)cp -f $< build/glint-frei0r.so.tmp && mv -f build/glint-frei0r.so.tmp build/glint-frei0r.so
else
frei0r:
	@$(MAKE) --no-print-directory PIC=yes frei0r
endif
# Eight instances at once, watched by ThreadSanitizer.
check-frei0r-threads:
	@$(MAKE) --no-print-directory CONFIG=tsan PIC=yes run-frei0r-threads
run-frei0r-threads: $(OUT)/glint-frei0r.so $(OUT)/frei0r_host
	@head -c 737280 tests/data/bridge.ppm | XDG_CACHE_HOME=$$PWD/build/cache GLINT_LENSES=$$PWD/lenses \
	        TSAN_OPTIONS=exitcode=9 $(OUT)/frei0r_host $< 192x120 8 quality=.25 gain@3=.3 lens@4=heliar-tronnier >$(OUT)/frames
	@echo '8 instances at once: no race'
.PHONY: frei0r check-frei0r-threads run-frei0r-threads

# A host of our own, for tests.
$(OUT)/frei0r_host: $(OUT)/tests/hosts/frei0r_host.o
	@mkdir -p $(@D)
	$(say) LD $@
	$(Q)$(CC) $(CFLAGS) $(LINKED) $(LDFLAGS) $^ -lpthread -ldl -o $@

# For tools/python: what its module is linked with, and the folder of archives.
print-out:
	@echo '$(taken)' $(OUT)
# The Python package, in an environment of its own.
check-python:
	@tools/make/deps "the Python package" gcc python3-cffi python3-numpy python3-setuptools python3-wheel python3-venv python3-pip
	@tests/hosts/python
.PHONY: print-out check-python

# Data sets by GNU parallel over ssh, and by a Slurm array on a cluster of its own.
check-spread: build/glint
	@tools/make/deps "data sets on many machines" parallel openssh-server openssh-client slurm-wlm munge
	@GLINT=build/glint XDG_CACHE_HOME=$$PWD/build/cache tests/hosts/spread
.PHONY: check-spread

# Every command that READMEs and manual pages name, those that take minutes, too.
check-commands:
	@tools/make/deps "the commands that READMEs name" gcc g++ pkg-config libopenimageio-dev ffmpeg
	@$(MAKE) --no-print-directory all oiio frei0r man
	@tests/hosts/commands --all
.PHONY: check-commands
