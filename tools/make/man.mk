# Manual pages, from where their text stands: help, READMEs, headers.
man: build/glint
	@mkdir -p build/man
	$(say) MAN build/man
	$(Q)for c in $$(build/glint --commands); do tools/man/page command build/glint $$c >build/man/glint-$$c.1 || exit 1; done
	$(Q)tools/man/page tour build/glint >build/man/glint.1
	$(Q)tools/man/page readme lenses/README.md glint-lens >build/man/glint-lens.5
	$(Q)tools/man/page readme tools/examples/scenes/README.md glint-scene >build/man/glint-scene.5
	$(Q)tools/man/page headers include/glint >build/man/glint.3
.PHONY: man
