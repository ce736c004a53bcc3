#!/usr/bin/env python3
"""Parses metrics from standard input with the strict OpenMetrics parser of prometheus_client; prints them as JSON."""

import json
import sys

from prometheus_client.openmetrics.parser import text_string_to_metric_families

found = {}
for family in text_string_to_metric_families(sys.stdin.read()):
    assert family.documentation, family.name
    found[family.name] = {
        "type": family.type,
        "samples": [[sample.name, sample.labels, sample.value] for sample in family.samples],
    }
json.dump(found, sys.stdout)
