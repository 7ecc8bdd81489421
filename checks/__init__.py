"""The checks, one package per exercise and named after it: scenarios run a learner's node, judges rule on the facts."""
