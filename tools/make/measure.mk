# What is looked at and what is measured. Tables go into the files of
# tests/figures; all of them, for hours, but for fits, which write weights into
# src: make figures. One of tools/measure/figure: make figure NAME=accuracy, with
# ROWS="lens=heliar-tronnier" some of its rows.
figures: all
	@tools/measure/write-figures --targets | grep -v -e -fit | while read -r target; do \
	        $(MAKE) --no-print-directory $$target || exit 1; done
# Lenses of GLINT_LENSES may bake for longer than 30 s.
figure: all $(OUT)/glint-measure
	@tools/make/deps "tables of figures" python3 >&2
	@GLINT_LENSES=tests/data/skew MEASURE=$(OUT)/glint-measure tools/measure/figure $(NAME) $(ROWS) | tools/measure/write-figures $(NAME)
# Some rows, a processor minute: fails where they are not the committed ones.
figures-quick: $(OUT)/glint-measure
	@tools/make/deps "tables of figures" python3 >&2
	@MEASURE=$(OUT)/glint-measure tools/measure/figure --quick
video-report: $(OUT)/steady
	@$(OUT)/steady --lens lenses/nikon-zoom-short.lens $(VIDEOS)
occlusion-table: $(OUT)/occlusion
	@$(OUT)/occlusion | tools/measure/write-figures occlusion
demo:
	@tools/make/deps "PNG and JPEG pictures, and video to look at" gcc libc6-dev g++ pkg-config \
	        libopenimageio-dev libwebp-dev ffmpeg
	@$(MAKE) --no-print-directory all \
	        $(shell [ "$(DEPS)" = no ] || echo oiio)
	@tools/make/demo
inputs:
	@tools/make/inputs
# Frame rate and latency of live on ARM, in an emulator.
latency-table:
	@$(MAKE) --no-print-directory TARGET=aarch64 glint-live >&2
	@tools/measure/latency-table | tools/measure/write-figures latency
# Seconds to a picture with each lens: half an hour.
first-picture-table: all
	@tools/measure/first-picture $(LENSES) | tools/measure/write-figures first-picture
# Scenes as POV-Ray draws them.
scene-table: all $(OUT)/scene_exact
	@tools/make/deps "scenes of another program" povray python3-numpy >&2
	@tests/peers/povray $(OUT) | tools/measure/write-figures scene
# A sun behind a ball: the light of its flare by frame.
hidden-table: all
	@tools/measure/hidden-table | tools/measure/write-figures scenes/hidden
# Meshes of Debian packages; pictures of some go to build/meshes.
mesh-table: all
	@tools/make/deps "meshes, and the plug-in for them" libassimp-dev pkg-config \
	        assimp-testmodels libcgal-demo >&2
	@$(MAKE) --no-print-directory assimp >&2
	@tools/measure/mesh-table | tools/measure/write-figures scenes/meshes
# Ward's lobe under eight panoramas of Debian's blender-data.
motion-table: all $(OUT)/motion_table
	@$(OUT)/motion_table $(or $(FRAMES),200000) | tools/measure/write-figures scenes/motion
ward-table: all $(OUT)/ward_table
	@tools/make/deps "pictures, and the plug-in for them" libopenimageio-dev pkg-config g++ >&2
	@$(MAKE) --no-print-directory oiio >&2
	@tools/measure/scenes/ward-table $(OUT)/ward_table | tools/measure/write-figures scenes/ward
# Models of scattering side by side, on synthetic translucent media: three processor minutes.
translucent-table: $(OUT)/translucent_table
	@$(OUT)/translucent_table | tools/measure/write-figures scenes/translucent
# What maps of translucent media cost, and how near they are.
stone-table: all $(OUT)/stone_rows $(OUT)/stone_cost
	@tools/make/deps "instruction counts, and those on ARM" valgrind gcc-aarch64-linux-gnu \
	        libc6-dev-arm64-cross qemu-user debian-archive-keyring >&2
	@$(MAKE) -s --no-print-directory TARGET=aarch64 \
	        SYSROOT=$$(tests/arm/prepare aarch64) build/aarch64/stone_cost >&2
	@tools/measure/scenes/stone-table $(OUT) | tools/measure/write-figures scenes/stone
# Four materials under the eight panoramas.
ward-sheet: all
	@tools/make/deps "contact sheets, panoramas" python3-pil libopenimageio-dev pkg-config g++ >&2
	@$(MAKE) --no-print-directory oiio >&2
	@tools/measure/scenes/ward-table true
	@tools/measure/scenes/ward-sheet tests/gallery/metals.jpg
colour-table: all
	@tools/make/deps "instruction counts" valgrind python3-numpy >&2
	@tools/measure/colour-table | tools/measure/write-figures colour
# The weights of src/lamps/unclip.c, from the half that is there to fit to.
power-fit: $(OUT)/power_table
	@tools/make/deps "HDR panoramas" openimageio-tools python3-numpy npm
	@tests/power-table $< >build/features.txt
	@tests/power-fit build/features.txt

# Photographs of Debian packages with their lamps marked: tests/corpus/README.md.
corpus:
	@tools/make/deps "photographs from Debian packages" python3-pil python3-numpy \
	        ffmpeg openimageio-tools
	@tests/corpus/fetch
HALF ?= tune
corpus-evaluate: corpus $(OUT)/corpus-found
	@tests/corpus/evaluate --half $(HALF) --sheet build/corpus/found-$(HALF).jpg
# Stars of two photographs by night, and ours.
corpus-stars: corpus all
	@tests/corpus/stars | tools/measure/write-figures stars
# All pictures beside what glint makes of them; how bright it is, lens by lens.
corpus-sheet: corpus all
	@tests/corpus/overlays build/corpus/sheet
EVERY ?= 1
MINUTES ?= 0
corpus-report: corpus all
	@tests/corpus/report build/corpus/report.csv \
	    --every $(EVERY) --minutes $(MINUTES) >build/report.md
	@tools/measure/write-figures brightness <build/report.md
# Photographs with our flares, and with real ones beside ours.
gallery: corpus all
	@tests/corpus/gallery tests/gallery
# The bridge by night through every lens.
lens-sheet: all oiio
	@tools/make/deps "contact sheets" python3-pil
	@tests/corpus/lenses build/lens-sheet.jpg
# The weights of src/lamps/score.c, from the pictures that are there to tune on.
corpus-fit: corpus $(OUT)/corpus-features
	@OUT=$(OUT) tests/corpus/fit
	@OUT=$(OUT) tests/corpus/fit --alone | tools/measure/write-figures finder
$(OUT)/tests/corpus/%.o: CPPFLAGS += -Itools/examples
$(OUT)/corpus-%: $(OUT)/tests/corpus/%.o $(libs)
	$(link)

bench: all
	@build/glint bench
size: $(OUT)/libglint.a $(example_bins)
	@tools/make/deps "bytes on ARM" gcc-aarch64-linux-gnu libc6-dev-arm64-cross \
	        gcc-arm-linux-gnueabihf libc6-dev-armhf-cross >&2
	@for t in aarch64 armv7; do $(MAKE) -s --no-print-directory TARGET=$$t \
	        $(EXAMPLES:%=build/$$t/examples/%) >&2 || exit 1; done
	@OUT=$(OUT) EXAMPLES='$(EXAMPLES)' tools/measure/size $(ARCH) aarch64 armv7 | tools/measure/write-figures size
trade: all
	@tools/make/deps "plots" python3 >&2
	@mkdir -p build/trade
	@build/glint sweep -o build/trade/sweep.csv $(TRADE)
	@tools/measure/plot-trade build/trade/sweep.csv >build/trade/trade.svg
# MODELS="A.glint ...": these; VIDEOS="A.y4m ...": these, too
reuse-table: MODELS = $(patsubst %,build/models/%.glint,double-gauss-angenieux canon-zoom-mid)
reuse-table: all $(OUT)/reuse
	@$(MAKE) -s --no-print-directory $(filter build/models/%,$(MODELS)) >&2
	@tools/make/deps "instruction counts, noise" valgrind ffmpeg >&2
	@tools/measure/reuse-table $(OUT)/reuse $(MODELS) | tools/measure/write-figures videos/reuse
reuse-table: export VIDEOS := $(VIDEOS)
zoom-halfway-table: all
	@tools/measure/zoom-halfway $(LENS) | tools/measure/write-figures shapes/zoom-halfway
# The weights of src/engine/frame/cost.c, by random frames.
cost-fit: all $(OUT)/cost_frames
	@tools/make/deps "instruction counts" valgrind >&2
	@tools/measure/cost-fit $(OUT)/cost_frames $(COUNTS) | tools/measure/write-figures cost/plans
budget: all
	@tools/make/deps "instruction counts on ARM" gcc-aarch64-linux-gnu \
	        libc6-dev-arm64-cross qemu-user >&2
	@for t in $${TARGETS:-aarch64}; do $(MAKE) -s --no-print-directory TARGET=$$t \
	        build/$$t/glint >&2 || exit 1; done
	@tools/measure/budget | tools/measure/write-figures arm

.PHONY: figures figure figures-quick first-picture-table latency-table video-report occlusion-table demo inputs scene-table hidden-table mesh-table \
        motion-table ward-table translucent-table stone-table ward-sheet colour-table power-fit corpus corpus-evaluate \
        corpus-stars corpus-sheet corpus-report gallery lens-sheet corpus-fit bench size trade reuse-table \
        zoom-halfway-table cost-fit budget
