# Documentation, and the site with the laboratory for browsers. Included by the Makefile.

# The manual in build/man: the pages of src/manual, four of them completed between their comments "begin PART" and "end
# PART" from the table of parameters, the list of quantities (src/job/quantities.c), results/README.md and the rows of
# make validate.
complete = set -o pipefail; $(2) | sed -i '/^\.\\" begin $(1)/r /dev/stdin' $(build)/man/man$(3)
validated := $(wildcard experiments/validation/*.cases) experiments/validation/cases.csv
$(build)/man/made: $(wildcard src/manual/man?/*) src/manual/results.awk results/README.md $(build)/cuvette \
  $(build)/account_keys src/manual/validation.awk $(validated)
	@rm -rf $(@D) && mkdir -p $(@D) && cp -r src/manual/man? $(@D)
	@$(call complete,parameters,$(build)/cuvette params --man,5/cuvette-scene.5)
	@$(call complete,account,$(build)/account_keys,5/cuvette-account.5)
	@$(call complete,results,awk -f src/manual/results.awk results/README.md,5/cuvette-results.5)
	@$(call complete,validation,awk -f src/manual/validation.awk $(validated),7/cuvette-validation.7)
	@touch $@
$(build)/account_keys: src/manual/account_keys.c $(build)/libcuvette.a $(build)/flags
	$(call say,$(CC) $<)
	$(quiet)$(CC) $(all_cflags) $(pkg_cflags) -MMD -MP -o $@ $< $(build)/libcuvette.a $(LDFLAGS) $(all_libs)

# The manual, the API, the lessons and the gallery as HTML in build/doc, to read offline.
.PHONY: doc doc-tools
## doc: the documentation as HTML: build/doc/index.html
doc: $(build)/cuvette $(build)/man/made doc-tools
	@rm -rf $(build)/doc
	@python3 -B src/manual/site/build.py $(build)/cuvette $(build)/man $(build)/doc
	@echo 'documentation: $(build)/doc/index.html'
doc-tools: | $(call requested,setup%)
	@for tool in python3 mandoc cmark-gfm; do command -v $$tool >/dev/null || \
	  { echo "doc: $$tool is not installed; run: make setup-doc" >&2; exit 1; }; done

# The tables of results/README.md, which people read where nothing is built, equal the list of quantities.
.PHONY: dictionary
## dictionary: renew the tables of results/README.md
dictionary: $(build)/tests/test_quantities
	@CUVETTE_RENEW=1 $< >/dev/null 2>&1 && $<

# The static site: documentation, and the laboratory with its engine in the browser.
.PHONY: site site-tools
## site: with the laboratory as well: build/site/index.html
site: $(build)/cuvette $(build)/man/made wasm | site-tools
	@rm -rf $(build)/site
	@python3 -B src/manual/site/build.py $(build)/cuvette $(build)/man $(build)/site laboratory/
	@python3 -B src/web/site/build.py build/wasm $(build)/site
	@cp $(build)/site/laboratory.html $(build)/live.html
	@echo 'site: $(build)/site/index.html; the laboratory in one file: $(build)/site/laboratory.html'
# Committed, since the program embeds those of the lessons: to be made again when a lesson or its scene changes.
.PHONY: page-images
# page-images: the gallery's images of lessons, and the site's first image
page-images: $(build)/cuvette
	@python3 -B src/web/site/images.py $(build)/cuvette
site-tools: doc-tools
	@command -v esbuild >/dev/null || { echo 'site: esbuild is not installed; run: make setup-site' >&2; exit 1; }
