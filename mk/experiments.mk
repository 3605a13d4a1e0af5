# Studies, tables, figures, the paper. Included by the Makefile.

.PHONY: experiments experiments-full tables figures claims paper
experiments: | $(call requested,test)
experiments-full: | $(call requested,test experiments)
claims paper: | $(call requested,experiments figures)
experiments: $(build)/cuvette-import
## experiments[-full]: the studies, tables, figures (resumes); QUICK=1
experiments: $(build)/cuvette
	@$(MAKE) --no-print-directory build=$(build) RESULTS=$(RESULTS) $(RESULTS)/figures/fan.svg $(RESULTS)/figures/trace.svg
	@$(run_studies)
run_studies = CUVETTE='$(abspath $(build)/cuvette)' experiments/run.sh $(if $(QUICK),--quick) --results '$(RESULTS)'
experiments-full: $(build)/cuvette-import
# The studies of experiments/full as well: an hour more.
experiments-full: $(build)/cuvette
	@$(run_studies) experiments/*.study experiments/full/*.study
	@$(if $(QUICK),,$(MAKE) --no-print-directory build=$(build) RESULTS=$(RESULTS) $(RESULTS)/tables/growth.tsv \
	  $(RESULTS)/tables/paths.tsv figures)

## tables: summarise the rows: RESULTS/tables
tables: $(build)/cuvette
	@CUVETTE='$(abspath $(build)/cuvette)' ENVIRONMENT='$(ENVIRONMENT)' experiments/tables.sh '$(RESULTS)'

# What no study can sweep: measured once; remove the table to measure again.
$(RESULTS)/tables/growth.tsv: | $(build)/cuvette
	@mkdir -p $(@D)
	CUVETTE='$(build)/cuvette' experiments/bench.sh growth >$@.new && mv $@.new $@
$(RESULTS)/tables/paths.tsv: | $(build)/cuvette
	@mkdir -p $(@D)
	CUVETTE='$(build)/cuvette' TABLE=$@.new experiments/bench.sh paths && mv $@.new $@

# One line says why another is skipped.
## figures: draw the figures whose rows exist
figures: tables $(RESULTS)/figures/fan.svg $(RESULTS)/figures/trace.svg $(RESULTS)/displacement/points.csv
	@mkdir -p $(RESULTS)
	plots/draw.sh --results $(RESULTS)

# How far the vessel moves what is seen through it.
$(RESULTS)/displacement/points.csv: experiments/displacement.sh experiments/scenes/rod.yaml | $(build)/cuvette
	@mkdir -p $(@D)
	experiments/displacement.sh $(build)/cuvette >$@.new && mv $@.new $@

# Rays through the filled vessel with focus and caustic; and the ray tree of one ray.
$(RESULTS)/figures/fan.svg: experiments/scenes/rod.yaml | $(build)/cuvette
	@mkdir -p $(@D)
	$(build)/cuvette fan $< --from -3,1.5,0 --to 3,1.5,0 --width 1.9 --rays 41 --set rod.visible=off -o $@
$(RESULTS)/figures/trace.svg: experiments/scenes/rod.yaml | $(build)/cuvette
	@mkdir -p $(@D)
	$(build)/cuvette trace $< --ray=-3,1.5,0.6,1,0,0 --depth 5 --set rod.visible=off -o $@

# The rows of this clone, or the committed run if there are none and no folder is given.
claimed = $(if \
  $(QUICK)$(filter-out file,$(origin RESULTS))$(wildcard $(RESULTS)/*/rows*.csv),$(RESULTS),results/reference)
# Reproduced, not reproduced, underpowered; RESULTS=DIR, ENVIRONMENT=HEX.
## claims: judge each claim of the paper by the rows
claims: $(build)/cuvette
	@CUVETTE='$(abspath $(build)/cuvette)' ENVIRONMENT='$(ENVIRONMENT)' experiments/tables.sh '$(claimed)'
	@paper/claims.py '$(claimed)' $(build)/claims

# Published tables and closed forms next to the program: cuvette-validation(7). RENEW=1 writes the rows and figures of
# that page.
.PHONY: validate
## validate: published values next to ours; RENEW=1 renews their page
validate: $(build)/cuvette
	@experiments/validate.py $(build)/cuvette $(build)/validation.csv
	$(if $(RENEW),@cp $(build)/validation.csv experiments/validation/cases.csv)
	$(if $(RENEW),@experiments/validation/figures.sh $(build)/cuvette experiments/validation)

## paper: rebuild the paper and its supplement from existing rows
paper: $(build)/cuvette
	$(MAKE) -C paper CUVETTE='$(abspath $(build)/cuvette)' $(if $(QUICK),RESULTS='$(RESULTS)')
