# trying out how lists work
numbers = [3, 1, 2]
numbers.sort()
print(numbers)
