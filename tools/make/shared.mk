# Shared libraries. Their objects are built once more, in a folder of their own:
# programs of glint's own are linked with archives.

# SOVERSION grows when programs have to be rebuilt.
SOVERSION := 0
VERSION   := $(shell sed -n 's/^.define GLINT_VERSION "\(.*\)"/\1/p' include/glint/glint.h)
# Each over the one before it.
LIBRARIES := glint glint-engine glint-bake
shared_names = lib$(1).so.$(VERSION) lib$(1).so.$(SOVERSION) lib$(1).so

# Libraries of others that they take: the run-time half none, and all.
taken_glint :=
taken_glint-engine := -lm -pthread
taken_glint-bake := $(if $(filter yes,$(WITH_JANSSON)),$(JANSSON_LIBS)) $(taken_glint-engine)
taken := $(taken_glint-bake)
# What a library shows is what public headers name of it, and for glint's other
# libraries what these take besides.
$(OUT)/%.map: $(LIBRARIES:%=$(OUT)/lib%.a) tools/make/exports $(wildcard include/glint/*.h include/glint/*/*.h)
	$(Q)tools/make/exports $(NM) $(OUT)/$*.a $(filter-out %/$*.a,$(filter %.a,$^)) >$@
$(OUT)/%.so.$(VERSION): $(OUT)/%.a $(OUT)/%.map
	$(say) LD $@
	$(Q)$(CC) $(CFLAGS) -shared -Wl,-soname,$*.so.$(SOVERSION) -Wl,--version-script=$(OUT)/$*.map \
	        -Wl,-Bsymbolic-functions -Wl,-z,defs $(filter -Wl%,$(LINKED)) -Wl,--whole-archive $< \
	        -Wl,--no-whole-archive $(filter %.so.$(VERSION),$^) \
	        -Wl,--as-needed $(taken) -o $@
	$(Q)ln -sf $(@F) $(OUT)/$*.so.$(SOVERSION) && ln -sf $(@F) $(OUT)/$*.so
$(OUT)/libglint-engine.so.$(VERSION): $(OUT)/libglint.so.$(VERSION)
$(OUT)/libglint-bake.so.$(VERSION): $(OUT)/libglint.so.$(VERSION) $(OUT)/libglint-engine.so.$(VERSION)

ifdef PIC
shared: $(LIBRARIES:%=$(OUT)/lib%.so.$(VERSION))
else
shared:
	@$(MAKE) --no-print-directory PIC=yes shared
endif

# The sources of the last commit, packed: the same bytes wherever it is done.
dist:
	@mkdir -p build
	git archive --prefix=glint-$(VERSION)/ HEAD | gzip -n >build/glint-$(VERSION).tar.gz
	@echo build/glint-$(VERSION).tar.gz
# What programs would notice of the change since REF, a commit or a tag.
abi: shared
	@[ -n "$(REF)" ] || { echo "make abi: with what? REF=HEAD~10, say" >&2; exit 2; }
	@tools/make/deps "differences of interfaces" abigail-tools git
	@tools/make/abi $(REF) $(OUT)-pic $(LIBRARIES)
.PRECIOUS: $(OUT)/%.map
.PHONY: shared dist abi
