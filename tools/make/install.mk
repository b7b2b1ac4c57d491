# To install, and to take away again.

# With TARGET= for a board: make DESTDIR a part of its image; for a board that runs,
# make board. The image plug-in is built where it can be. MODELS=no: without baked models of
# the lenses, which take minutes where there are none yet.
program := $(if $(CROSS),$(OUT)/glint,build/glint)
PLUGIN  ?= $(if $(CROSS),no,$(shell command -v $(CXX) >/dev/null && \
        pkg-config --exists OpenImageIO 2>/dev/null && echo yes || echo no))
MESHES  ?= $(if $(CROSS),no,$(shell pkg-config --exists assimp 2>/dev/null && echo yes || echo no))
WINDOW  ?= $(if $(CROSS),no,$(shell pkg-config --exists sdl2 2>/dev/null && echo yes || echo no))
FREI0R  ?= $(if $(CROSS),no,yes)
ELEMENT ?= $(if $(CROSS),no,$(shell pkg-config --exists gstreamer-video-1.0 2>/dev/null && echo yes || echo no))
MODELS  ?= $(if $(CROSS),no,yes)
MANUAL  ?= $(if $(CROSS),no,yes)
to := $(DESTDIR)$(PREFIX)
# GStreamer looks in one folder of the system, and where GST_PLUGIN_PATH says.
element_to := $(or $(if $(CROSS),,$(if $(filter /usr,$(PREFIX)),$(shell pkg-config --variable=pluginsdir gstreamer-1.0 2>/dev/null))),$(LIBDIR)/gstreamer-1.0)
libdir := $(DESTDIR)$(LIBDIR)
lib := $(LIBDIR:$(PREFIX)/%=%)
strip_too := $(if $(filter yes,$(STRIP)),-s $(CROSS:%=--strip-program=%strip))
# Completions, by the folders in which shells look for them.
shells := bash-completion/completions/glint.bash zsh/site-functions/_glint fish/vendor_completions.d/glint.fish
lens_rooms := $(patsubst %/,%,$(wildcard lenses/*/))
install: install-library install-programs $(if $(filter yes,$(PLUGIN)),build/glint-oiio.so) \
        $(if $(filter yes,$(MESHES)),build/glint-assimp.so) \
        $(if $(filter yes,$(WINDOW)),build/glint-sdl.so) $(if $(filter yes,$(MANUAL)),man)
	$(if $(filter yes,$(FREI0R)),$(MAKE) --no-print-directory frei0r)
	$(if $(filter yes,$(ELEMENT)),$(MAKE) --no-print-directory gstreamer)
	install -d $(libdir)/glint
	install -m 644 tests/data/bridge.$(if $(filter yes,$(PLUGIN)),jpg,ppm) $(to)/share/glint
	$(if $(filter yes,$(PLUGIN)),install $(strip_too) -m 755 build/glint-oiio.so $(libdir)/glint, \
	        @echo 'without the image plug-in (g++, pkg-config, libopenimageio-dev): PPM, PFM, y4m, and PNG and JPEG by their libraries')
	$(if $(filter yes,$(MESHES)),install $(strip_too) -m 755 build/glint-assimp.so $(libdir)/glint, \
	        @echo 'without the mesh plug-in (pkg-config, libassimp-dev): OBJ')
	$(if $(filter yes,$(WINDOW)),install $(strip_too) -m 755 build/glint-sdl.so $(libdir)/glint)
	$(if $(filter yes,$(FREI0R)),install -d $(to)/lib/frei0r-1 && install $(strip_too) -m 644 build/glint-frei0r.so $(to)/lib/frei0r-1/glint.so)
	$(if $(filter yes,$(ELEMENT)),install -d $(DESTDIR)$(element_to) && install $(strip_too) -m 644 $(placed_gstreamer) $(DESTDIR)$(element_to))
	$(if $(filter yes-no,$(ELEMENT)-$(if $(filter /usr,$(PREFIX)),yes,no)),@echo 'for GStreamer: export GST_PLUGIN_PATH=$(element_to)')
	if [ -e build/web/glint.wasm ]; then install -d $(to)/share/glint/web && install -m 644 build/web/* $(to)/share/glint/web; fi
	install -d $(addprefix $(to)/share/,$(dir $(shells)) $(if $(filter yes,$(MANUAL)),man/man1 man/man3 man/man5))
	for s in $(shells); do install -m 644 tools/man/$${s##*/} $(to)/share/$$s || exit 1; done
	mv $(to)/share/bash-completion/completions/glint.bash $(to)/share/bash-completion/completions/glint
	$(if $(filter yes,$(MANUAL)),for n in 1 3 5; do install -m 644 build/man/*.$$n $(to)/share/man/man$$n || exit 1; done)
# The files that programs need at run time: all that a board needs.
install-programs: all glint-live
	install -d $(to)/bin $(to)/share/glint/lenses $(to)/lib/systemd/system
	install $(strip_too) -m 755 \
	        $(program) $(OUT)/glint-live $(to)/bin
	install -m 644 lenses/*.lens $(to)/share/glint/lenses
	for r in $(lens_rooms); do install -d $(to)/share/glint/$$r && \
	        install -m 644 $$r/*.lens $(to)/share/glint/$$r || exit 1; done
	sed 's,@PREFIX@,$(PREFIX),' platform/linux/glint-live.service \
	        >$(to)/lib/systemd/system/glint-live.service
	chmod 644 $(to)/lib/systemd/system/glint-live.service
ifneq ($(MODELS),no)
	@echo 'baking the models of all lenses, where there are none yet (MODELS=no: later)'
	$(if $(CROSS),$(MAKE) --no-print-directory TARGET= build/glint)
	rm -rf build/models-installed # of other tables
	build/glint lenses --models build/models-installed $(patsubst lenses/%.lens,--only %,$(wildcard lenses/*.lens))
	install -d $(to)/share/glint/models
	install -m 644 build/models-installed/*.glint $(to)/share/glint/models
endif
# These packed, to be unpacked by root in / of a running board: of folders those of
# glint alone are in it, as tar gives a folder that is there the owner and mode of
# its entry.
board_prefix := $(if $(filter file,$(origin PREFIX)),/usr,$(PREFIX))
board_tar := build/glint-$(VERSION)-$(notdir $(OUT)).tar.gz
board:
	@[ -n "$(CROSS)" ] || { echo "make board: which machine? TARGET=aarch64, say: $(TARGETS)" >&2; exit 2; }
	rm -rf $(OUT)/root
	$(MAKE) --no-print-directory install-programs DESTDIR=$(OUT)/root PREFIX=$(board_prefix)
	cd $(OUT)/root && find $(board_prefix:/%=%) -type f -o -type d -path '*/share/glint*' | LC_ALL=C sort | \
	        tar --owner=0 --group=0 --numeric-owner --mode=u=rwX,go=rX --no-recursion -T - -czf $(CURDIR)/$(board_tar).tmp
	@mv -f $(board_tar).tmp $(board_tar) && echo $(board_tar)
# What programs are built and run with; for a board archives alone.
headers := $(wildcard include/glint/*.h include/glint/*.inc include/glint/*/*.h)
install-library: $(LIBRARIES:%=$(OUT)/lib%.a) $(if $(CROSS),,shared)
	install -d $(to)/include/glint/scene $(libdir)/pkgconfig
	install -m 644 $(filter-out $(wildcard include/glint/*/*.h),$(headers)) $(to)/include/glint
	install -m 644 include/glint/scene/*.h $(to)/include/glint/scene
	install -m 644 $(LIBRARIES:%=$(OUT)/lib%.a) $(libdir)
	$(if $(CROSS),,cp -P $(addprefix $(OUT)-pic/,$(foreach l,$(LIBRARIES),$(call shared_names,$l))) $(libdir))
	$(if $(filter yes,$(STRIP)),$(CROSS)strip -g $(LIBRARIES:%=$(libdir)/lib%.a) \
	        $(if $(CROSS),,$(LIBRARIES:%=$(libdir)/lib%.so.$(VERSION))))
	$(foreach l,$(LIBRARIES),tools/make/pkg-config $l $(PREFIX) $(LIBDIR) $(VERSION) '$(taken_$l)' >$(libdir)/pkgconfig/$l.pc && \
	        chmod 644 $(libdir)/pkgconfig/$l.pc &&) :
# What install put there, and folders that are empty then.
uninstall:
	rm -f $(to)/bin/glint $(to)/bin/glint-live $(libdir)/glint/glint-oiio.so \
	        $(LIBRARIES:%=$(libdir)/lib%.a) \
	        $(addprefix $(libdir)/,$(foreach l,$(LIBRARIES),$(call shared_names,$l))) \
	        $(LIBRARIES:%=$(libdir)/pkgconfig/%.pc) $(headers:%=$(to)/%) \
        $(libdir)/glint/glint-assimp.so $(libdir)/glint/glint-sdl.so $(to)/lib/frei0r-1/glint.so $(DESTDIR)$(element_to)/libgstglint.so \
	        $(to)/lib/systemd/system/glint-live.service \
	        $(patsubst %,$(to)/share/glint/%,$(wildcard lenses/*.lens lenses/*/*.lens)) \
	        $(addprefix $(to)/share/,$(shells:.bash=)) $(to)/share/man/man1/glint.1 $(to)/share/man/man1/glint-*.1 \
	        $(to)/share/man/man3/glint.3 $(to)/share/man/man5/glint-lens.5 $(to)/share/man/man5/glint-scene.5 \
	        $(to)/share/glint/models/*.glint $(to)/share/glint/bridge.jpg $(to)/share/glint/bridge.ppm \
	        $(patsubst %,$(to)/share/glint/web/%,glint.wasm sample.jpg $(notdir $(web_files)))
	@for d in include/glint/scene include/glint $(lib)/pkgconfig $(lib)/glint lib/frei0r-1 $(lib)/gstreamer-1.0 share/glint/models share/glint/web $(lens_rooms:%=share/glint/%) share/glint/lenses share/glint \
	        $(patsubst %/,share/%,$(dir $(shells))) share/bash-completion share/zsh share/fish \
	        share/man/man1 share/man/man3 share/man/man5 share/man lib/systemd/system lib/systemd; do \
	        if [ -d $(to)/$$d ]; then rmdir --ignore-fail-on-non-empty $(to)/$$d; fi; done
.PHONY: install install-programs install-library board uninstall
