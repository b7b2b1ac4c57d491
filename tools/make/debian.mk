# Debian packages: tools/debian.

DEBIAN_TOOLS := mmdebstrap dpkg-dev git util-linux procps
debian:
	@tools/make/deps "Debian packages" $(DEBIAN_TOOLS)
	@tools/debian/build $(DEBIAN)
# Of the shared libraries as they are.
debian-symbols: shared
	@tools/debian/symbols $(OUT)-pic $(VERSION) $(LIBRARIES) >tools/debian/libglint0.symbols
check-symbols: shared
	@tools/debian/symbols $(OUT)-pic $(VERSION) $(LIBRARIES) | diff tools/debian/libglint0.symbols - || \
	        { echo 'exported functions have changed: make debian-symbols'; exit 1; }
# Built, looked through, installed, tried, purged; on arm64, too. About an hour.
check-debian:
	@tools/make/deps "Debian packages, and ARM in an emulator" $(DEBIAN_TOOLS) lintian qemu-user-static arch-test
	@tests/packages/check $(DEBIAN)
.PHONY: debian debian-symbols check-symbols check-debian
