# What the build and the checks require, the Python module, installation, packages. Included by the Makefile.

# Debian's apt installs for one caller at a time: each waits for those before it that are requested, too.
setups := setup $(addprefix setup-,peers python mpi simgrid doc paper instructions wasm site web arch slurm deb)
.PHONY: $(setups)
$(foreach s,$(setups),$(eval $(s): | $(call requested,$(before)))$(eval before += $(s)))
setup-arch: private of_setup = $(build)/arch $(arch)
setup-web: private of_setup = $(build)/web-tests
## setup: install the required packages (Debian 12), once
## setup-NAME: install what NAME or test-NAME requires (.ci)
$(setups):
	@PYTHON='$(PYTHON)' .ci/$@ $(of_setup)

# The Python module (src/python): Python text only, which loads the shared library of this build or installation.
PYTHON ?= $(firstword $(wildcard /usr/bin/python3) python3)
module := $(build)/python/cuvette
module_sources := $(wildcard src/python/cuvette/*.py src/python/cuvette/py.typed)
$(module)/_declarations.py: src/python/declare.py src/cuvette.h $(module_sources) $(build)/cuvette
	$(call say,python $@)
	@mkdir -p $(@D)
	$(quiet)$(build)/cuvette params --json >$(build)/python/params.json
	$(quiet)cp $(module_sources) $(@D)/
	$(quiet)$(PYTHON) src/python/declare.py src/cuvette.h $(build)/python/params.json $(@D)
.PHONY: python test-python
## python: the Python module: PYTHONPATH=build/python
python: $(module)/_declarations.py all
## test-python: the Python module with pytest; only=NAME
test-python: python | $(call requested,test test-mpi test-web experiments bench)
	@MALLOC_PERTURB_=165 PYTHONPATH='$(abspath $(build)/python)' CUVETTE='$(abspath $(build)/cuvette)' CC='$(CC)' \
	  $(PYTHON) -m pytest -q -p no:cacheprovider $(if $(only),$(only:%=tests/python/test_%.py),tests/python)

.PHONY: install install-python uninstall
LIBDIR ?= $(PREFIX)/lib
share := $(PREFIX)/share
pages := $(patsubst src/manual/%,%,$(wildcard src/manual/man?/*))
# What is installed: mode, file and place of each, without DESTDIR. The list that notes it is what `make uninstall`
# reads.
list := $(share)/cuvette/installed-files
define files
  echo '755 $(build)/cuvette $(PREFIX)/bin/cuvette'; \
  $(if $(wildcard $(build)/cuvette-mpi)$(call requested,mpi), \
    echo '755 $(build)/cuvette-mpi $(PREFIX)/bin/cuvette-mpi';) \
  echo '755 $(build)/cuvette-import $(PREFIX)/libexec/cuvette/cuvette-import'; \
  echo '644 src/cuvette.h $(PREFIX)/include/cuvette.h'; \
  echo '644 $(build)/engine/libcuvette.a $(LIBDIR)/libcuvette.a'; \
  echo '644 $(build)/$(soname) $(LIBDIR)/libcuvette.so.$(version)'; \
  echo 'link libcuvette.so.$(version) $(LIBDIR)/$(soname)'; \
  echo 'link $(soname) $(LIBDIR)/libcuvette.so'; \
  echo '644 $(build)/cuvette.pc $(LIBDIR)/pkgconfig/cuvette.pc'; \
  for page in $(pages); do echo "644 $(build)/man/$$page $(share)/man/$$page"; done; \
  echo '644 src/cli/cuvette.bash $(share)/bash-completion/completions/cuvette'; \
  for text in LICENSE README.md CHANGELOG.md src/licences.md; do \
    echo "644 $$text $(share)/doc/cuvette/$${text##*/}"; done; \
  $(if $(wildcard $(build)/live.html)$(call requested,site),echo '644 $(build)/live.html $(share)/cuvette/live.html';) \
  find experiments plots -type f ! -path '*/__pycache__/*' | while read -r file; do \
    test -x "$$file" && mode=755 || mode=644; echo "$$mode $$file $(share)/cuvette/$$file"; done
endef
# Below DESTDIR; with cuvette-mpi where make mpi has built it, and live.html of make site.
## install[-python]: install under PREFIX, below DESTDIR; the Python module
install: $(build)/cuvette $(build)/man/made $(build)/cuvette-import $(build)/$(soname) $(build)/engine/libcuvette.a | \
  $(call requested,mpi site)
	@sed 's|@PREFIX@|$(PREFIX)|; s|@LIBDIR@|$(LIBDIR)|; s|@VERSION@|$(version)|; s|@LIBRARIES@|$(strip $(all_libs))|' \
	  src/cuvette.pc.in >$(build)/cuvette.pc
	@{ $(files); } | DESTDIR='$(DESTDIR)' .ci/install '$(list)'
	@.ci/install-notes '$(DESTDIR)' '$(PREFIX)' '$(LIBDIR)'
# The Python module, where python3 finds it.
module_place = $(shell $(PYTHON) src/python/place.py $(PREFIX))/cuvette
install-python: python install
	@for file in $(module)/*.py $(module)/py.typed; do echo "644 $$file $(module_place)/$${file##*/}"; done | \
	  DESTDIR='$(DESTDIR)' .ci/install '$(list)'
## uninstall: remove the files that make install installed
uninstall:
	@DESTDIR='$(DESTDIR)' .ci/install --remove '$(list)'

.PHONY: deb test-deb
## deb: the Debian packages in build/deb, checked by lintian
deb: | $(call requested,setup%)
	@MAKEFLAGS= .ci/deb $(build)/deb
## test-deb: the packages in a fresh Debian 12 (root, debootstrap)
test-deb:
	@.ci/test-deb $(build)/deb
