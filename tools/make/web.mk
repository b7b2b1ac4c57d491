# The page of tools/hosts/web: glint as a WebAssembly module, by Debian's clang, lld
# and WASI, and the files that a web server serves, in build/web.

WEB_PACKAGES := clang lld llvm wasi-libc libclang-rt-dev-wasm32
wasm := build/wasm32/glint.wasm
wasm_tests := build/wasm32/test_kernels.wasm build/wasm32/test_ward_kernels.wasm
web_files := $(wildcard $(addprefix tools/hosts/web/*.,html css js svg))
web:
	@tools/make/deps "the page" $(WEB_PACKAGES)
	@$(MAKE) --no-print-directory wasm
	@mkdir -p build/web
	$(Q)cp $(wasm) $(web_files) build/web && cp tests/data/bridge.jpg build/web/sample.jpg
	@echo "build/web/glint.wasm: $$(wc -c <build/web/glint.wasm) bytes, $$(gzip -9c build/web/glint.wasm | wc -c) by gzip"
# The package for npm, in build/npm.
npm:
	@tools/make/deps "the package for npm" $(WEB_PACKAGES) nodejs
	@$(MAKE) --no-print-directory wasm
	@mkdir -p build/npm
	$(Q)cp $(wasm) tools/hosts/web/glint.js tools/hosts/web/npm/example.js build/npm
	$(Q)sed 's/"private"/"version": "$(VERSION)",\n  &/' tools/hosts/web/package.json >build/npm/package.json
	$(Q)node tools/hosts/web/npm/types.js $(wasm) >build/npm/glint.d.ts
# The module alone. Objects of another machine, as those of boards.
wasm:
	@$(MAKE) --no-print-directory CC='clang --target=wasm32-wasi -msimd128' OUT=build/wasm32 LDFLAGS=-static \
	        WITH_JPEG=no WITH_PNG=no WITH_JANSSON=no WITH_EXPAT=no $(wasm) $(wasm_tests)
# The same without SIMD, whose kernels are those in C, for tests.
wasm-plain:
	@$(MAKE) --no-print-directory CC='clang --target=wasm32-wasi' sets_wasm32= OUT=build/wasm32-plain LDFLAGS=-static \
	        WITH_JPEG=no WITH_PNG=no WITH_JANSSON=no WITH_EXPAT=no build/wasm32-plain/glint.wasm
# Pictures of the module are those of the program.
check-web: build/glint
	@tools/make/deps "the page's module" $(WEB_PACKAGES) nodejs node-typescript
	@XDG_CACHE_HOME=$(CURDIR)/build/cache GLINT=build/glint tests/hosts/web --all
.PHONY: web npm wasm wasm-plain check-web
web_o := $(patsubst %,$(OUT)/%.o,tools/hosts/web/glint_web tools/hosts/web/tables tools/glint/desk/styles tools/glint/model/ghost_file tools/glint/overlay/grey \
         tools/glint/options/numbers tools/glint/options/timed_text platform/formats/tones platform/posix/error web_lens)
$(OUT)/web_lens.c: tools/hosts/web/lens_tables $(wildcard lenses/*.lens lenses/*/*.lens)
	@mkdir -p $(@D)
	$(Q)$^ >$@
$(OUT)/web_lens.o: $(OUT)/web_lens.c
	$(say) CC $<
	$(Q)$(CC) -Itools/hosts -Os -c $< -o $@
$(OUT)/glint.wasm: $(core_o) $(engine_o) $(bake_o) $(web_o)
	$(say) LD $@
	$(Q)$(CC) -mexec-model=reactor -Wl,-s,--gc-sections,-z,stack-size=1048576 $(filter %.o,$^) -o $@
$(wasm_tests): build/wasm32/%.wasm: build/wasm32/tests/unit/kernels/%.o $(OUT)/platform/linux/sets.o $(core_o)
	$(say) LD $@
	$(Q)$(CC) -Wl,--gc-sections $(filter %.o,$^) -o $@
ifeq ($(ARCH),wasm32)
# NAN of this C library is a float.
$(engine_o): CFLAGS += -Wno-double-promotion
endif
