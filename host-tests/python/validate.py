"""Faults of JSON documents against a JSON Schema: {"schema": ..., "documents": [...]} in, a list for each document out."""

import json
import sys

import jsonschema

asked = json.load(sys.stdin)
kind = jsonschema.validators.validator_for(asked["schema"])
kind.check_schema(asked["schema"])
validator = kind(asked["schema"])
faults = [[f"{fault.json_path}: {fault.message}" for fault in validator.iter_errors(one)] for one in asked["documents"]]
json.dump(faults, sys.stdout)
