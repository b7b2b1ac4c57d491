# What is looked at and what is measured. Tables go into the files of
# tests/figures.

video-report: $(OUT)/steady
	@{ echo "revision $$(git rev-parse --short HEAD), $$(nproc)-core $$(uname -m) machine"; \
	    echo; $(OUT)/steady --lens lenses/nikon-zoom-short.lens $(VIDEOS) || \
	    echo "steady: a step is larger than its bound" >&2; } | tools/report/write-figures steady
demo:
	@tools/make/deps "PNG and JPEG pictures, and video to look at" g++ pkg-config \
	        libopenimageio-dev libwebp-dev ffmpeg
	@$(MAKE) --no-print-directory all \
	        $(shell [ "$(DEPS)" = no ] || echo oiio)
	@tools/make/demo
inputs:
	@tools/make/inputs
table: all
	@tools/report/raster-table | tools/report/write-figures raster
bake-table: all $(OUT)/ray_errors
	@tools/report/bake-table | tools/report/write-figures bake
# LENSES="A.lens ...": these; EVERY=N: each Nth angle; OPEN=N, STOPS="...".
wide-table: all
	@tools/report/wide-table $(LENSES) | tools/report/write-figures wide
wide-table: export EVERY := $(EVERY)
accuracy-table: all
	@tools/report/accuracy-table | tools/report/write-figures accuracy
colour-table: all $(OUT)/hue_steps
	@tools/make/deps "instruction counts" valgrind >&2
	@HUE_STEPS=$(OUT)/hue_steps tools/report/colour-table | tools/report/write-figures colour
ray-table: all $(OUT)/ray_errors
	@tools/report/ray-table build/bake | tools/report/write-figures rays
power-table: $(OUT)/power_table
	@tools/make/deps "HDR panoramas" openimageio-tools python3 npm
	@tests/power-table $< | tools/report/write-figures power
# The weights of src/lamps/unclip.c, from the half that is there to fit to.
power-fit: $(OUT)/power_table
	@tools/make/deps "HDR panoramas" openimageio-tools python3-numpy npm
	@tests/power-table $< --features >build/features.txt
	@tests/power-fit build/features.txt
$(OUT)/ray_errors: $(OUT)/tools/lab/ray_errors.o $(libs)
	$(link)

# Photographs of Debian packages with their lamps marked: tests/corpus/README.md.
corpus:
	@tools/make/deps "photographs from Debian packages" python3-pil python3-numpy \
	        ffmpeg openimageio-tools
	@tests/corpus/fetch
HALF ?= tune
corpus-evaluate: corpus $(OUT)/corpus-found
	@tests/corpus/evaluate --half $(HALF) --sheet build/corpus/found-$(HALF).jpg
# All pictures beside what glint makes of them; how bright it is, lens by lens.
corpus-sheet: corpus all
	@tests/corpus/overlays build/corpus/sheet
EVERY ?= 1
MINUTES ?= 0
corpus-report: corpus all
	@tests/corpus/report build/corpus/report.csv \
	    --every $(EVERY) --minutes $(MINUTES) >build/report.md
	@{ echo "Revision $$(git rev-parse --short HEAD)."; cat build/report.md; } | \
	    tools/report/write-figures brightness
# The bridge by night through every lens.
lens-sheet: all oiio
	@tools/make/deps "contact sheets" python3-pil
	@tests/corpus/lenses build/lens-sheet.jpg
# The weights of src/lamps/score.c, from the pictures that are there to tune on.
corpus-fit: corpus $(OUT)/corpus-features
	@OUT=$(OUT) tests/corpus/fit
	@OUT=$(OUT) tests/corpus/fit --alone | tools/report/write-figures finder
$(OUT)/tests/corpus/%.o: CPPFLAGS += -Itools/examples
$(OUT)/corpus-%: $(OUT)/tests/corpus/%.o $(libs)
	$(link)

bench: all
	@build/glint bench
bench-insn: all
	@tools/make/deps "instruction counts" valgrind
	@tools/report/bench-insn
growth: all
	@tools/report/growth | tools/report/write-figures growth
size: $(OUT)/libglint.a $(example_bins)
	@tools/report/size $(SIZE) $(OUT) $(EXAMPLES)
trade: all
	@build/glint sweep -o build/trade $(TRADE)
	@echo build/trade/index.html
lights-table: $(OUT)/lights
	@$(OUT)/lights 0 $(MODELS) | tools/report/write-figures lights
hostile-table: $(OUT)/hostile_models
	@$(OUT)/hostile_models | tools/report/write-figures hostile
memory-table: all
	@tools/report/memory-table | tools/report/write-figures memory
budget: all
	@tools/make/deps "instruction counts on ARM" gcc-aarch64-linux-gnu \
	        libc6-dev-arm64-cross gcc-arm-linux-gnueabihf \
	        libc6-dev-armhf-cross qemu-user valgrind >&2
	@for t in aarch64 armv7; do $(MAKE) -s --no-print-directory TARGET=$$t \
	        build/$$t/glint >&2 || exit 1; done
	@tools/report/budget | tools/report/write-figures arm

.PHONY: video-report demo inputs table bake-table wide-table accuracy-table colour-table ray-table power-table \
        power-fit \
        corpus corpus-evaluate corpus-sheet corpus-report corpus-fit lens-sheet \
        bench bench-insn growth size trade lights-table hostile-table memory-table budget
