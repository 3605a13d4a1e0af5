# The static site: documentation, and the laboratory with its engine in the browser. Included by the Makefile.

.PHONY: site site-tools setup-site
site_setups = $(filter setup setup-wasm setup-doc setup-site,$(MAKECMDGOALS))
setup-site: | $(filter setup setup-peers setup-doc setup-wasm,$(MAKECMDGOALS)) ## install what make site requires besides setup-wasm: esbuild, mandoc, cmark-gfm, python3
	@.ci/setup-site
site: $(build)/cuvette $(build)/man/made wasm | site-tools ## write the static site, with the laboratory for any browser: build/site/index.html
	@rm -rf $(build)/site
	@python3 -B src/manual/site/build.py $(build)/cuvette $(build)/man $(build)/site laboratory/
	@python3 -B src/web/site/build.py build/wasm $(build)/site
	@cp $(build)/site/laboratory.html $(build)/live.html
	@echo 'site: $(build)/site/index.html; the laboratory in one file: $(build)/site/laboratory.html'
site-tools: doc-tools | $(site_setups)
	@command -v esbuild >/dev/null || { echo 'site: esbuild is not installed; run: make setup-site' >&2; exit 1; }
